#pragma once
#include <cstdint>

namespace takt::sim {

/// Pseudo-random numbers that are the same with every library and on every machine: SplitMix64.
class Random {
 public:
  explicit constexpr Random(std::uint64_t seed) noexcept : state_{seed} {}

  constexpr std::uint64_t next() noexcept {
    std::uint64_t z = (state_ += 0x9E37'79B9'7F4A'7C15);
    z = (z ^ (z >> 30)) * 0xBF58'476D'1CE4'E5B9;
    z = (z ^ (z >> 27)) * 0x94D0'49BB'1331'11EB;
    return z ^ (z >> 31);
  }
  /// 0 .. limit - 1; 0 where limit is 0.
  constexpr std::uint32_t below(std::uint32_t limit) noexcept {
    return static_cast<std::uint32_t>(((next() >> 32) * limit) >> 32);
  }
  /// True with this probability; draws no number where the answer is certain.
  constexpr bool chance(double probability) noexcept {
    if (probability <= 0.0) return false;
    if (probability >= 1.0) return true;
    return static_cast<double>(next() >> 11) * 0x1.0p-53 < probability;
  }
  /// A generator of its own for a part, so that parts do not disturb one another.
  constexpr Random fork(std::uint64_t salt) const noexcept {
    Random child{state_ ^ (salt * 0xD6E8'FEB8'6659'FD93)};
    return Random{child.next()};
  }

 private:
  std::uint64_t state_;
};

}  // namespace takt::sim
