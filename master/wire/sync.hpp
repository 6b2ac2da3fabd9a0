#pragma once
#include <cstdint>

#include "master/wire/frame.hpp"

namespace takt {

/// Returns a SYNC without counter, for 0x1019 = 0. CiA 301, 7.2.5.
constexpr Frame sync_frame(CobId id) noexcept { return Frame{.id = id}; }

/// Returns a SYNC with a counter of 1..240.
constexpr Frame sync_frame(CobId id, std::uint8_t counter) noexcept {
  return make_frame(id, {counter});
}

/// Returns the counter of a received SYNC; 0 means that the frame has no counter.
constexpr std::uint8_t sync_counter(const Frame& frame) noexcept {
  return frame.length == 0 ? std::uint8_t{0} : frame.data[0];
}

}  // namespace takt
