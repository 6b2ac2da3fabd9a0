#include "master/gateway/motion/axis_motion_limits.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <string_view>

namespace takt {
namespace {

/// Returns true if `unit` is a rate of positions in the unit `position`, such as mm/s for mm. A
/// limit without a unit is in counts, and so are positions without a unit.
bool is_rate_of(const std::string& unit, const std::string& position) {
  return unit.empty() ? position.empty() : unit.starts_with(position + "/");
}

/// Returns the limit of the command, or `of_file` if the command has none (0). The limit of the
/// command must not exceed `of_file`, the limit of the network file or of the drive.
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
    return std::unexpected{
        fmt::format("max_{} is {}, but `limits:` of the network file or the drive allow {}", name,
                    wanted, *of_file)};
  }
  return wanted;
}

/// Returns the positions that an INTEGER32 target position can hold.
motion::PositionRange range_of_integer32(const Signal& target) {
  constexpr double counts = std::numeric_limits<std::int32_t>::max();
  const double one = target.offset - counts * target.scale;
  const double other = target.offset + counts * target.scale;
  return {.min = std::min(one, other), .max = std::max(one, other)};
}

/// A set-point is rounded to a count, so a step may be one count longer than the exact distance.
double velocity_of_step(double step, const Signal& target, Time period) {
  const double way = std::max(step - std::abs(target.scale), step / 2);
  return way / std::chrono::duration<double>{period}.count();
}

/// Returns the narrower one of two limits.
std::optional<double> narrower(std::optional<double> a, std::optional<double> b) {
  return a && b ? std::min(*a, *b) : a ? a : b;
}

/// Without a limit of jerk, the acceleration reaches its limit within this time, in s.
constexpr double default_rise = 0.05;

}  // namespace

AxisMotionLimits::AxisMotionLimits(const BusPlan& plan) : signals_{motion_axes(plan)} {
  for (const MotionAxis& axis : signals_) {
    const Signal& target = plan.layout.signals[axis.target];
    const double turn = axis.turn.in_unit(target.scale, target.offset).length;
    axes_.push_back(
        {.range = turn > 0.0 ? motion::PositionRange{} : range_of_integer32(target), .turn = turn});
  }
  for (const LimitLine& line : plan.limits.lines) add(plan, line);
}

void AxisMotionLimits::add(const BusPlan& plan, const LimitLine& line) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const MotionAxis& axis = signals_[i];
    if (line.node_index != axis.node_index || line.axis != axis.number + 1 || !line.high) continue;
    const Signal& target = plan.layout.signals[axis.target];
    Axis& found = axes_[i];
    if (line.kind == LimitKind::position && line.unit == target.unit) {
      const motion::PositionRange widest = range_of_integer32(target);
      const motion::PositionRange range{.min = std::max(widest.min, line.low.value_or(widest.min)),
                                        .max = std::min(widest.max, *line.high)};
      const double length = range.max - range.min + std::abs(target.scale);
      if (found.turn == 0.0 || length < found.turn) {
        found.range = range;
        found.turn = 0.0;
      }
    }
    if (line.kind == LimitKind::following_error && line.unit == target.unit) {
      found.following_error = line.high;
    }
    if (line.kind == LimitKind::step && line.unit == target.unit) {
      found.step_velocity = velocity_of_step(*line.high, target, plan.cycle.period);
    }
    if (!is_rate_of(line.unit, target.unit)) continue;
    if (line.kind == LimitKind::velocity) found.velocity = line.high;
    if (line.kind == LimitKind::acceleration) found.acceleration = line.high;
    if (line.kind == LimitKind::jerk) found.jerk = line.high;
  }
}

/// Takes the limit that was read from a drive. LimitLine::scale and LimitLine::offset convert it to
/// the unit of the limit.
void AxisMotionLimits::learn(const BusPlan& plan, std::size_t place, std::int64_t read) {
  if (place >= plan.limits.lines.size()) return;
  LimitLine line = plan.limits.lines[place];
  if (line.source != LimitSource::device) return;
  const auto value = [&](std::int64_t raw) {
    return static_cast<double>(raw) * line.scale + line.offset;
  };
  if (line.kind == LimitKind::position) {
    const double one = value(read >> 32);
    const double other = value(static_cast<std::int32_t>(read & 0xFFFF'FFFF));
    line.low = std::min(one, other);
    line.high = std::max(one, other);
  } else {
    line.high = std::abs(value(read));
  }
  add(plan, line);
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
  const auto velocity =
      limit(goal.max_velocity, narrower(known.velocity, known.step_velocity), "velocity");
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
