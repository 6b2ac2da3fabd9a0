#include "master/core/axis_memory.hpp"

#include "master/core/axis_stop.hpp"

namespace takt {
namespace {

/// Switch on, enable voltage and no quick stop: no axis leaves "ready to switch on" without them.
/// CiA 402-2, 0x6040.
bool enables(std::int64_t controlword) noexcept { return (controlword & 0x07) == 0x07; }

}  // namespace

void AxisMemory::look(std::optional<std::int64_t> statusword,
                      std::optional<std::int64_t> controlword) noexcept {
  if (written_ || (controlword && enables(*controlword))) {
    quiet_ = 0;
    disabled_ = false;
  } else if (quiet_ < settling_cycles) {
    ++quiet_;
  }
  if (statusword) see(*statusword);
}

void AxisMemory::see(std::int64_t statusword) noexcept {
  disabled_ = AxisStop::disabled(statusword) && quiet_ >= settling_cycles;
}

void AxisMemory::write(std::int64_t controlword) noexcept {
  written_ = enables(controlword);
  if (!written_) return;
  quiet_ = 0;
  disabled_ = false;
}

}  // namespace takt
