#pragma once
#include "eds_parser/table/time.hpp"
#include "master/linux/clock.hpp"

namespace takt {

/// The clocks of a front thread or of an application: those of the machine, or of a simulation.
class Clocks {
 public:
  virtual ~Clocks() = default;
  /// Monotonic, the time of everything inside takt.
  virtual Time now() const noexcept = 0;
  /// The wall clock minus now().
  virtual Time wall_offset() const noexcept = 0;
};

class LinuxClocks final : public Clocks {
 public:
  Time now() const noexcept override { return monotonic_now(); }
  Time wall_offset() const noexcept override { return realtime_offset(); }
};

}  // namespace takt
