#include "apps/drive402/set_point_handshake.hpp"

namespace takt {
namespace {

constexpr std::uint16_t new_set_point = 0x0010;
constexpr std::uint16_t at_once = 0x0020;
constexpr std::uint16_t acknowledged = 0x1000;

}  // namespace

void SetPointHandshake::begin(SetPointTiming timing) noexcept {
  next_timing_ = timing;
  if (phase_ == Phase::idle) {
    phase_ = Phase::before;
    timing_ = timing;
  } else {
    again_ = true;
  }
}

std::uint16_t SetPointHandshake::step(std::uint16_t statusword) noexcept {
  const bool seen = (statusword & acknowledged) != 0;
  if (phase_ == Phase::lowered && !seen) {
    phase_ = again_ ? Phase::before : Phase::idle;
    timing_ = next_timing_;
    again_ = false;
  }
  if (phase_ == Phase::before && !seen) {
    phase_ = Phase::raised;  // The drive can take a set-point: raise bit 4.
  } else if (phase_ == Phase::raised && seen) {
    phase_ = Phase::lowered;
  }
  const std::uint16_t change = timing_ == SetPointTiming::immediately ? at_once : 0;
  return phase_ == Phase::raised ? new_set_point | change : change;
}

}  // namespace takt
