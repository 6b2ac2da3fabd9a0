#pragma once
#include "eds_parser/values/time.hpp"
#include "master/linux/clock.hpp"

namespace takt {

/// The clocks of a front thread or of an application, either of the machine or of a simulation.
class Clocks {
 public:
  virtual ~Clocks() = default;
  /// Returns the monotonic time, the time base of takt.
  virtual Time now() const noexcept = 0;
  /// Returns the wall clock time minus now().
  virtual Time wall_offset() const noexcept = 0;
};

class LinuxClocks final : public Clocks {
 public:
  Time now() const noexcept override { return monotonic_now(); }
  Time wall_offset() const noexcept override { return realtime_offset(); }
};

}  // namespace takt
