#pragma once
#include <array>

#include "master/motion/profile.hpp"

namespace takt::motion {

/// A function of time of degree 5 or less: c[0] + c[1] t + ... + c[5] t^5.
using Polynomial = std::array<double, 6>;

/// The least and the greatest value of a function in an interval.
struct Extremes {
  double min = 0.0;
  double max = 0.0;
};

constexpr double value_at(const Polynomial& c, double t) noexcept {
  return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
}

constexpr Polynomial derivative_of(const Polynomial& c) noexcept {
  return {c[1], 2 * c[2], 3 * c[3], 4 * c[4], 5 * c[5], 0.0};
}

/// Returns the position as a function of time that has both states, `duration` seconds apart.
Polynomial quintic_between(const State& from, const State& to, double duration) noexcept;
/// Returns the cubic polynomial that has both positions and velocities. Its accelerations follow
/// from these values.
Polynomial cubic_between(const State& from, const State& to, double duration) noexcept;

/// Returns the extremes between 0 and `duration`, up to rounding. It never allocates.
Extremes extremes_of(const Polynomial& c, double duration) noexcept;

}  // namespace takt::motion
