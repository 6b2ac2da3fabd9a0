#include "master/motion/position_range.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace takt::motion {
namespace {

/// Returns the times at which the velocity is 0 if the jerk is constant. A time is infinite, NaN or
/// negative if there is no such moment.
std::array<double, 2> turning_times(const State& state, double jerk) noexcept {
  const double a = state.acceleration;
  if (jerk == 0.0) return {-state.velocity / a, -1.0};
  const double root = std::sqrt(a * a - 2 * jerk * state.velocity);
  // The sum of two numbers with the same sign loses no digits. The second time follows from this
  // sum.
  const double sum = -(a + std::copysign(root, a));
  return {sum / jerk, 2 * state.velocity / sum};
}

}  // namespace

PositionRange widened(const PositionRange& range, double position) noexcept {
  return {.min = std::min(range.min, position), .max = std::max(range.max, position)};
}

PositionRange positions_of(const Profile& profile, const State& from) noexcept {
  PositionRange seen{.min = from.position, .max = from.position};
  const auto look = [&](const State& state) {
    seen.min = std::min(seen.min, state.position);
    seen.max = std::max(seen.max, state.position);
  };
  State state = from;
  for (const Segment& segment : profile.segments()) {
    for (const double time : turning_times(state, segment.jerk)) {
      if (time > 0.0 && time < segment.duration) look(advanced(state, time, segment.jerk));
    }
    state = advanced(state, segment.duration, segment.jerk);
    look(state);
  }
  return seen;
}

bool stays_inside(const PositionRange& range, const Profile& profile, const State& from) noexcept {
  constexpr double tolerance = 1e-9;
  if (std::isinf(range.min) && std::isinf(range.max)) return true;
  const PositionRange seen = positions_of(profile, from);
  const double size = tolerance * std::max(std::abs(seen.min), std::abs(seen.max));
  return seen.min >= range.min - size && seen.max <= range.max + size;
}

}  // namespace takt::motion
