#pragma once
#include <cstdint>

#include "eds_parser/table/pdo_table.hpp"
#include "master/core/pdo/pdo_outputs.hpp"
#include "master/rt/exchange/process_image.hpp"

namespace takt {

/// Sets outputs from within the cycle. The values take effect at the next SYNC.
class OutputWriter {
 public:
  OutputWriter(PdoOutputs& outputs, OutputMoment moment) noexcept
      : outputs_{outputs}, moment_{moment} {}
  /// `signal` is an index into the whole layout. `time_to_live` counts cycles; 0 selects the
  /// configured value.
  void set(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live = 0) noexcept {
    outputs_.command(signal, value, time_to_live, moment_);
  }

 private:
  PdoOutputs& outputs_;
  OutputMoment moment_;
};

/// A control law that runs inside the bus thread, for applications that need a lower latency than
/// LCM offers. It must not allocate, lock or make system calls.
class Controller {
 public:
  virtual ~Controller() = default;
  /// The loop calls this once per cycle, right after it has published the image.
  virtual void update(const ImageView& image, OutputWriter& outputs) noexcept = 0;
};

}  // namespace takt
