#include "apps/move/move_sizes.hpp"

#include <cmath>
#include <fmt/format.h>

namespace takt {
namespace {

/// Returns a distance that is visible as a motion and that fits most machines.
double default_distance(const std::string& unit) {
  if (unit == "rad") return 1.5;
  if (unit == "deg" || unit == "°") return 90.0;
  if (unit == "m") return 0.1;
  if (unit == "mm") return 100.0;
  return 10000.0;  // raw counts
}

}  // namespace

MoveSizes sizes_for(const MoveOptions& options, const std::string& unit) {
  const double distance = default_distance(unit);
  return {.distance = distance,
          .amplitude = options.amplitude.value_or(distance / 6.0),
          .following_limit = options.following_limit.value_or(distance / 30.0),
          .limits = {.velocity = options.velocity.value_or(distance * 0.8),
                     .acceleration = options.acceleration.value_or(distance * 2.0),
                     .jerk = options.jerk.value_or(distance * 10.0)}};
}

std::string too_long(const MotionTime& time, double limit) {
  const double whole = time.move + time.sine;
  if (whole <= limit) return {};
  std::string parts;
  if (time.move > 0.0) parts = fmt::format("the move takes {:.2f} s", time.move);
  if (time.sine > 0.0) {
    parts += fmt::format("{}one period of the sine takes {:.2f} s", parts.empty() ? "" : " and ",
                         time.sine);
  }
  return fmt::format("{}, but --for allows {:g} s: no axis moves. Give --for {:.2f}s or more",
                     parts, limit, std::ceil(whole * 100.0) / 100.0);
}

}  // namespace takt
