#pragma once
#include <cstdint>

#include "eds_parser/table/pdo_table.hpp"
#include "master/core/pdo_outputs.hpp"
#include "master/rt/process_image.hpp"

namespace takt {

/// Sets outputs from within the cycle. Values act at the next SYNC.
class OutputWriter {
 public:
  OutputWriter(PdoOutputs& outputs, OutputMoment moment) noexcept
      : outputs_{outputs}, moment_{moment} {}
  /// `signal` counts in the whole layout; `time_to_live` in cycles, 0: as configured.
  void set(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live = 0) noexcept {
    outputs_.command(signal, value, time_to_live, moment_);
  }

 private:
  PdoOutputs& outputs_;
  OutputMoment moment_;
};

/// A control law inside the bus thread, for those who need less latency than LCM has. Must not
/// allocate, lock or make system calls.
class Controller {
 public:
  virtual ~Controller() = default;
  /// Once a cycle, right after the image was published.
  virtual void update(const ImageView& image, OutputWriter& outputs) noexcept = 0;
};

}  // namespace takt
