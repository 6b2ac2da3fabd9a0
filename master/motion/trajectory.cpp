#include "master/motion/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace takt::motion {
namespace {

AxisMotion motion_of(const AxisTask& task, Goal goal) noexcept {
  return {task.from, task.to, task.limits, goal};
}

bool all_finite(const AxisTask& task) noexcept {
  const Limits& limits = task.limits;
  const std::array numbers{task.from.position,      task.from.velocity,  task.from.acceleration,
                           task.to.position,        task.to.velocity,    task.to.acceleration,
                           limits.max_velocity,     limits.min_velocity, limits.max_acceleration,
                           limits.min_acceleration, limits.jerk};
  return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

/// Returns true if `value` is between both limits. An excess that rounding explains is permitted.
bool is_between(double low, double value, double high) noexcept {
  constexpr double tolerance = 1.0 + 1e-12;
  return value >= low * tolerance && value <= high * tolerance;
}

/// Returns a duration of at least `duration` for which the axis has a motion inside its range of
/// positions. The shortest motion reverses as early as the axis can, so if it leaves the range,
/// most longer motions leave it too. The function therefore tries only a few longer durations.
std::expected<double, Defect> possible(const AxisTask& task, Goal goal, double duration) noexcept {
  const AxisMotion motion = motion_of(task, goal);
  const PositionRange range = widened(task.range, task.from.position);
  double time = motion.possible(duration);
  for (int i = 0; i < 50; ++i) {
    if (!std::isfinite(time)) return std::unexpected{Defect::not_finite};
    if (stays_inside(range, motion.profile(time), task.from)) return time;
    time = motion.possible(1.1 * time);
  }
  return std::unexpected{Defect::position_range};
}

/// Returns the shortest duration of at least `duration` that is possible for all tasks. The loop
/// ends soon, because each pass skips a range of durations that is impossible for an axis, and an
/// axis has few such ranges.
std::expected<double, Refused> common_duration(std::span<const AxisTask> tasks, Goal goal,
                                               double duration) noexcept {
  static constexpr double rounding = 1.0 + 8 * std::numeric_limits<double>::epsilon();
  for (bool passed = true; passed;) {
    passed = false;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const auto time = possible(tasks[i], goal, duration);
      if (!time) return std::unexpected{Refused{.axis = i, .defect = time.error()}};
      if (*time <= duration * rounding) continue;
      duration = *time;
      passed = true;
    }
  }
  return duration;
}

Profile scaled(const Profile& profile, double share) noexcept {
  Profile result;
  for (const Segment& segment : profile.segments()) {
    result.add(segment.duration, segment.jerk * share);
  }
  return result;
}

/// Plans the tasks as a motion on a straight line. Returns std::nullopt if there is no such motion.
std::optional<double> plan_line(std::span<const AxisTask> tasks, const TrajectoryOptions& options,
                                std::span<PlannedAxis> planned) noexcept {
  const auto line = StraightLine::find(tasks, options.goal);
  if (!line) return std::nullopt;
  const auto duration = possible(line->leader(), options.goal, options.minimum_duration);
  if (!duration) return std::nullopt;
  const Profile profile = motion_of(line->leader(), options.goal).profile(*duration);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    planned[i].profile = scaled(profile, line->share(tasks[i]));
    planned[i].duration = *duration;
  }
  return *duration;
}

}  // namespace

std::expected<void, Defect> defect_of(const AxisTask& task) noexcept {
  const Limits& limits = task.limits;
  if (!all_finite(task)) return std::unexpected{Defect::not_finite};
  if (!(limits.min_velocity < 0.0 && limits.max_velocity > 0.0)) {
    return std::unexpected{Defect::velocity_limits};
  }
  if (!(limits.min_acceleration < 0.0 && limits.max_acceleration > 0.0)) {
    return std::unexpected{Defect::acceleration_limits};
  }
  if (!(limits.jerk > 0.0)) return std::unexpected{Defect::jerk_limit};
  const double v = task.to.velocity;
  const double a = task.to.acceleration;
  if (!is_between(limits.min_velocity, v, limits.max_velocity)) {
    return std::unexpected{Defect::target_velocity};
  }
  if (!is_between(limits.min_acceleration, a, limits.max_acceleration)) {
    return std::unexpected{Defect::target_acceleration};
  }
  const double before = v - a * std::abs(a) / (2 * limits.jerk);
  if (!is_between(limits.min_velocity, before, limits.max_velocity)) {
    return std::unexpected{Defect::velocity_before_target};
  }
  return {};
}

std::expected<double, Refused> plan_trajectory(std::span<const AxisTask> tasks,
                                               const TrajectoryOptions& options,
                                               std::span<PlannedAxis> planned) noexcept {
  double longest = options.minimum_duration;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (const auto sound = defect_of(tasks[i]); !sound) {
      return std::unexpected{Refused{.axis = i, .defect = sound.error()}};
    }
    const auto shortest = possible(tasks[i], options.goal, 0.0);
    if (!shortest) return std::unexpected{Refused{.axis = i, .defect = shortest.error()}};
    planned[i].shortest = *shortest;
    longest = std::max(longest, *shortest);
  }
  if (options.synchronisation == Synchronisation::phase) {
    if (const auto duration = plan_line(tasks, options, planned)) return *duration;
  }
  if (options.synchronisation != Synchronisation::none) {
    const auto common = common_duration(tasks, options.goal, longest);
    if (!common) return common;
    for (PlannedAxis& axis : planned) axis.duration = *common;
  } else {
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const auto duration = possible(tasks[i], options.goal, options.minimum_duration);
      if (!duration) return std::unexpected{Refused{.axis = i, .defect = duration.error()}};
      planned[i].duration = *duration;
    }
  }
  double duration = 0.0;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    planned[i].profile = motion_of(tasks[i], options.goal).profile(planned[i].duration);
    duration = std::max(duration, planned[i].duration);
  }
  return duration;
}

}  // namespace takt::motion
