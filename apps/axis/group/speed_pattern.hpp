#pragma once
#include <algorithm>
#include <cstdint>
#include <takt/speed_pattern_t.hpp>

namespace takt {

/// Returns true if the status word of a speed axis shows this state.
inline bool shows(const speed_pattern_t& pattern, std::uint16_t word) noexcept {
  const std::int32_t bits = word & pattern.mask;
  return pattern.mask != 0 && std::ranges::find(pattern.values, bits) != pattern.values.end();
}

}  // namespace takt
