#include "master/core/network/axis_memory.hpp"

#include "master/core/network/axis_stop.hpp"

namespace takt {
namespace {

/// Returns true if the word has the bits "switch on" and "enable voltage", and no quick stop. No
/// axis leaves "ready to switch on" without them. CiA 402-2, 0x6040.
bool enables(std::int64_t controlword) noexcept { return (controlword & 0x07) == 0x07; }

/// Returns true if the axis is disabled, and an enabling controlword that the drive already has
/// changes nothing, because the drive needs the command "shutdown" first. CiA 402-2, transitions 2
/// and 3.
bool inert(std::int64_t statusword) noexcept {
  const bool ready_to_switch_on = (statusword & 0x6F) == 0x21;
  return AxisStop::disabled(statusword) && !ready_to_switch_on;
}

}  // namespace

void AxisMemory::look(std::optional<std::int64_t> statusword,
                      std::optional<std::int64_t> controlword) noexcept {
  if (awaits_answer() || (controlword && enables(*controlword))) {
    quiet_ = 0;
    disabled_ = false;
  } else if (quiet_ < standing_cycles) {
    ++quiet_;
  }
  if (statusword) see(*statusword);
}

void AxisMemory::see(std::int64_t statusword) noexcept {
  switch (word_) {
    case ServiceWord::harmless:
      disabled_ = AxisStop::disabled(statusword) && quiet_ >= settling_cycles;
      return;
    case ServiceWord::under_way:
      disabled_ = false;
      return;
    case ServiceWord::standing:
      disabled_ = inert(statusword) && quiet_ >= standing_cycles;
      if (disabled_) word_ = ServiceWord::harmless;
      return;
  }
}

/// Takes note only of an enabling controlword. That a drive is disabled must be shown by its
/// statusword.
void AxisMemory::write(std::int64_t controlword) noexcept {
  if (!enables(controlword)) return;
  word_ = ServiceWord::under_way;
  quiet_ = 0;
  disabled_ = false;
}

void AxisMemory::confirm() noexcept {
  if (word_ != ServiceWord::standing || quiet_ < settling_cycles) return;
  word_ = ServiceWord::harmless;
  disabled_ = true;
}

}  // namespace takt
