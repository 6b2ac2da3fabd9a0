#pragma once
#include <cstdint>

#include "eds_parser/values/time.hpp"

namespace takt::sim {

/// SplitMix64, a generator of pseudo-random numbers that are the same with every library and on
/// every machine.
class Random {
 public:
  explicit constexpr Random(std::uint64_t seed) noexcept : state_{seed} {}

  constexpr std::uint64_t next() noexcept {
    std::uint64_t z = (state_ += 0x9E37'79B9'7F4A'7C15);
    z = (z ^ (z >> 30)) * 0xBF58'476D'1CE4'E5B9;
    z = (z ^ (z >> 27)) * 0x94D0'49BB'1331'11EB;
    return z ^ (z >> 31);
  }
  /// Returns a number in 0 .. limit - 1, or 0 if `limit` is 0.
  constexpr std::uint32_t below(std::uint32_t limit) noexcept {
    return static_cast<std::uint32_t>(((next() >> 32) * limit) >> 32);
  }
  /// Returns a time in 1 ns .. longest.
  constexpr Time up_to(Time longest) noexcept {
    return Time{1 + static_cast<Time::rep>(next() % static_cast<std::uint64_t>(longest.count()))};
  }
  /// Returns true with this probability. Draws no number if the probability is 0 or 1.
  constexpr bool chance(double probability) noexcept {
    if (probability <= 0.0) return false;
    if (probability >= 1.0) return true;
    return static_cast<double>(next() >> 11) * 0x1.0p-53 < probability;
  }
  /// Returns a separate generator for one part of the simulation, so that parts do not disturb one
  /// another.
  constexpr Random fork(std::uint64_t salt) const noexcept {
    Random child{state_ ^ (salt * 0xD6E8'FEB8'6659'FD93)};
    return Random{child.next()};
  }

 private:
  std::uint64_t state_;
};

}  // namespace takt::sim
