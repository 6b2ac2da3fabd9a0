#include "master/motion/planner/stream_check.hpp"

#include <algorithm>
#include <cmath>

#include "master/motion/beat/stop_profile.hpp"

namespace takt::motion {
namespace {

/// The largest excess that counts as rounding, relative to the limits.
constexpr double rounding = 1e-9;

bool is_inside(const Extremes& found, double min, double max, double size) noexcept {
  const double excess = rounding * size;
  return found.min >= min - excess && found.max <= max + excess;
}

double largest(const Extremes& found) noexcept { return std::max(-found.min, found.max); }

/// The extremes of a segment.
struct Course {
  Extremes position;
  Extremes velocity;
  Extremes acceleration;
  Extremes jerk;
};

Course course_of(const StreamSegment& segment) noexcept {
  const double time = segment.duration();
  const Polynomial velocity = derivative_of(segment.position());
  const Polynomial acceleration = derivative_of(velocity);
  return {.position = extremes_of(segment.position(), time),
          .velocity = extremes_of(velocity, time),
          .acceleration = extremes_of(acceleration, time),
          .jerk = extremes_of(derivative_of(acceleration), time)};
}

std::optional<StreamDefect> defect_of_course(const Course& course,
                                             const StreamRules& rules) noexcept {
  const Limits& limits = rules.limits;
  const double size = std::max({1.0, -course.position.min, course.position.max});
  if (!is_inside(course.velocity, limits.min_velocity, limits.max_velocity,
                 limits.max_velocity - limits.min_velocity)) {
    return StreamDefect::velocity;
  }
  if (!is_inside(course.acceleration, limits.min_acceleration, limits.max_acceleration,
                 limits.max_acceleration - limits.min_acceleration)) {
    return StreamDefect::acceleration;
  }
  if (!is_inside(course.jerk, -limits.jerk, limits.jerk, limits.jerk)) return StreamDefect::jerk;
  if (!is_inside(course.position, rules.range.min, rules.range.max, size)) {
    return StreamDefect::position;
  }
  return std::nullopt;
}

/// Returns an upper limit of the distance of a stop that begins on the segment. A stop takes the
/// acceleration to 0 first, and the velocity may rise meanwhile. Then it brakes along the limits.
double longest_stop(const Course& course, const Limits& limits) noexcept {
  const double acceleration = largest(course.acceleration);
  const double rise = acceleration / limits.jerk;
  const double velocity = largest(course.velocity) + acceleration * rise / 2;
  const double braking = std::min(limits.max_acceleration, -limits.min_acceleration);
  return velocity * rise + velocity / 2 * (velocity / braking + braking / limits.jerk);
}

/// Returns true if a stop from this state begins to brake at a velocity that is within the limits.
bool coasts_inside(const State& state, const Limits& limits) noexcept {
  const double velocity =
      state.velocity + state.acceleration * std::abs(state.acceleration) / (2 * limits.jerk);
  return is_inside({.min = velocity, .max = velocity}, limits.min_velocity, limits.max_velocity,
                   limits.max_velocity - limits.min_velocity);
}

}  // namespace

std::optional<StreamDefect> defect_of_way(const StreamPoint& from, const StreamPoint& to,
                                          const StreamRules& rules) noexcept {
  if (!is_finite(to)) return StreamDefect::not_finite;
  if (!(to.time > from.time)) return StreamDefect::not_later;
  const StreamSegment segment{from, to};
  const auto is_number = [](double number) { return std::isfinite(number); };
  if (!std::ranges::all_of(segment.position(), is_number)) return StreamDefect::not_finite;
  return defect_of_course(course_of(segment), rules);
}

/// The check includes the cycle of `from`: the bus thread is on the new curve in this cycle, and a
/// cubic curve begins with another acceleration than the one with which the previous curve ended.
std::optional<StreamDefect> defect_of_stops(const StreamPoint& from, const StreamPoint& to,
                                            const StreamRules& rules) noexcept {
  const StreamSegment segment{from, to};
  const Course course = course_of(segment);
  const double stop = longest_stop(course, rules.limits);
  const bool is_far = course.position.min - stop >= rules.range.min &&
                      course.position.max + stop <= rules.range.max;
  for (double cycle = std::floor(from.time / rules.period); cycle * rules.period <= to.time;
       ++cycle) {
    if (cycle * rules.period < from.time) continue;
    const State state = segment.at(cycle * rules.period);
    if (!coasts_inside(state, rules.limits)) return StreamDefect::stop_velocity;
    if (is_far) continue;
    if (!stays_inside(rules.range, stop_profile(state, rules.limits), state)) {
      return StreamDefect::stop_position;
    }
  }
  return std::nullopt;
}

}  // namespace takt::motion
