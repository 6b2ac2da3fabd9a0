#pragma once
#include <limits>

namespace takt {

/// Returns true if this number is finite but too large for a REAL32, in which it would become
/// infinite.
constexpr bool exceeds_real32(double value) noexcept {
  constexpr double most = std::numeric_limits<float>::max();
  constexpr double largest = std::numeric_limits<double>::max();
  return (value > most && value <= largest) || (value < -most && value >= -largest);
}

}  // namespace takt
