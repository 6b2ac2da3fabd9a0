#include "master/gateway/motion/axis_motion_limits.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <string_view>

namespace takt {
namespace {

/// A limit without unit is in counts, as the positions are then.
bool is_rate_of(const std::string& unit, const std::string& position) {
  return unit.empty() ? position.empty() : unit.starts_with(position + "/");
}

/// Takes the limit of the command, which must not exceed that of the file.
std::expected<double, std::string> limit(double wanted, std::optional<double> of_file,
                                         std::string_view name) {
  if (!std::isfinite(wanted) || wanted < 0.0) {
    return std::unexpected{
        fmt::format("max_{} is {}: it must be above 0, or 0 for the limit of the "
                    "network file",
                    name, wanted)};
  }
  const double least = AxisMotionLimits::smallest;
  const double most = AxisMotionLimits::largest;
  if (wanted != 0.0 && (wanted < least || wanted > most)) {
    return std::unexpected{
        fmt::format("max_{} is {}, which is not between {} and {}", name, wanted, least, most)};
  }
  if (wanted == 0.0 && of_file) return std::clamp(*of_file, least, most);
  if (wanted == 0.0) {
    return std::unexpected{
        fmt::format("there is no limit of {}: set max_{} in the command, or "
                    "`limits: {{{}: ...}}` in the network file",
                    name, name, name)};
  }
  if (of_file && wanted > *of_file) {
    return std::unexpected{fmt::format("max_{} is {}, but `limits:` of the network file allow {}",
                                       name, wanted, *of_file)};
  }
  return wanted;
}

/// The positions that the target position can hold.
motion::PositionRange range_of_integer32(const Signal& target) {
  constexpr double counts = std::numeric_limits<std::int32_t>::max();
  const double one = target.offset - counts * target.scale;
  const double other = target.offset + counts * target.scale;
  return {.min = std::min(one, other), .max = std::max(one, other)};
}

/// Without a limit of jerk, the acceleration reaches its limit within this time, in s.
constexpr double default_rise = 0.05;

}  // namespace

AxisMotionLimits::AxisMotionLimits(const BusPlan& plan) {
  for (const MotionAxis& axis : motion_axes(plan)) axes_.push_back(limits_of(plan, axis));
}

AxisMotionLimits::Axis AxisMotionLimits::limits_of(const BusPlan& plan, const MotionAxis& axis) {
  const std::string& unit = plan.layout.signals[axis.target].unit;
  Axis found{.range = range_of_integer32(plan.layout.signals[axis.target])};
  for (const LimitLine& line : plan.limits.lines) {
    if (line.node_index != axis.node_index || line.axis != axis.number + 1 || !line.high) continue;
    if (line.kind == LimitKind::position && line.unit == unit) {
      found.range = {.min = std::max(found.range.min, line.low.value_or(found.range.min)),
                     .max = std::min(found.range.max, *line.high)};
    }
    if (line.kind == LimitKind::following_error && line.unit == unit) {
      found.following_error = line.high;
    }
    if (!is_rate_of(line.unit, unit)) continue;
    if (line.kind == LimitKind::velocity) found.velocity = line.high;
    if (line.kind == LimitKind::acceleration) found.acceleration = line.high;
    if (line.kind == LimitKind::jerk) found.jerk = line.high;
  }
  return found;
}

std::expected<double, std::string> AxisMotionLimits::following_error(
    std::size_t axis, const motion_goal_t& goal) const {
  const std::optional<double>& of_file = axes_[axis].following_error;
  if (goal.max_following_error != 0.0 || of_file) {
    return limit(goal.max_following_error, of_file, "following_error");
  }
  return std::numeric_limits<double>::infinity();
}

std::expected<motion::Limits, std::string> AxisMotionLimits::of(std::size_t axis,
                                                                const motion_goal_t& goal) const {
  const Axis& known = axes_[axis];
  const auto velocity = limit(goal.max_velocity, known.velocity, "velocity");
  if (!velocity) return std::unexpected{velocity.error()};
  const auto acceleration = limit(goal.max_acceleration, known.acceleration, "acceleration");
  if (!acceleration) return std::unexpected{acceleration.error()};
  const bool free_jerk = goal.max_jerk == 0.0 && !known.jerk;
  const auto jerk =
      free_jerk
          ? std::expected<double, std::string>{std::min(*acceleration / default_rise, largest)}
          : limit(goal.max_jerk, known.jerk, "jerk");
  if (!jerk) return std::unexpected{jerk.error()};
  return motion::Limits{.max_velocity = *velocity,
                        .min_velocity = -*velocity,
                        .max_acceleration = *acceleration,
                        .min_acceleration = -*acceleration,
                        .jerk = *jerk};
}

}  // namespace takt
