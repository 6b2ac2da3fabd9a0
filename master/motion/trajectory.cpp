#include "master/motion/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "master/motion/precision.hpp"

namespace takt::motion {
namespace {

/// Largest number of durations that are tried to stay inside a range of positions.
constexpr int most_tries = 50;
constexpr int most_passes = 50;  ///< over all axes, to find a duration that is possible for all

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

/// Plans the shortest motion of one axis that lasts at least `duration` and stays inside its range
/// of positions. The shortest motion reverses as early as the axis can, so if it leaves the range,
/// most longer motions leave it too. The function therefore tries only a few longer durations.
std::expected<void, Defect> plan_axis(const AxisTask& task, Goal goal, double duration,
                                      PlannedAxis& planned) noexcept {
  const AxisMotion motion{task.from, task.to, task.limits, goal};
  const PositionRange range = widened(task.range, task.from.position);
  double time = motion.possible(duration);
  for (int i = 0; i < most_tries; ++i) {
    if (!std::isfinite(time)) return std::unexpected{Defect::not_finite};
    planned.profile = motion.profile(time);
    planned.duration = time;
    if (stays_inside(range, planned.profile, task.from)) return {};
    time = motion.possible(1.1 * time);
  }
  return std::unexpected{Defect::position_range};
}

/// Plans all tasks again with the shortest duration that is possible for all of them and is at
/// least `duration`, and returns it. Each pass skips a range of durations that is impossible for an
/// axis. An axis has few such ranges, so two or three passes are enough.
std::expected<double, Refused> plan_together(std::span<const AxisTask> tasks, Goal goal,
                                             double duration,
                                             std::span<PlannedAxis> planned) noexcept {
  static constexpr double rounding = 1.0 + 8 * std::numeric_limits<double>::epsilon();
  std::size_t last = 0;
  for (int pass = 0; pass < most_passes; ++pass) {
    bool passed = false;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      if (planned[i].duration == duration) continue;
      if (const auto done = plan_axis(tasks[i], goal, duration, planned[i]); !done) {
        return std::unexpected{Refused{.axis = i, .defect = done.error()}};
      }
      if (planned[i].duration > duration * rounding) {
        duration = planned[i].duration;
        passed = true;
        last = i;
      }
      planned[i].duration = duration;
    }
    if (!passed) return duration;
  }
  return std::unexpected{Refused{.axis = last, .defect = Defect::common_duration}};
}

/// Plans each task for itself with at least this duration. Returns the longest duration.
std::expected<double, Refused> plan_apart(std::span<const AxisTask> tasks, Goal goal,
                                          double duration,
                                          std::span<PlannedAxis> planned) noexcept {
  double longest = 0.0;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (planned[i].duration < duration) {
      if (const auto done = plan_axis(tasks[i], goal, duration, planned[i]); !done) {
        return std::unexpected{Refused{.axis = i, .defect = done.error()}};
      }
    }
    longest = std::max(longest, planned[i].duration);
  }
  return longest;
}

bool is_precise(const AxisTask& task, Goal goal, const Profile& profile) noexcept {
  return is_precise(task.from, task.to, task.limits, goal, profile);
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
  PlannedAxis leader;
  if (!plan_axis(line->leader(), options.goal, options.minimum_duration, leader)) {
    return std::nullopt;
  }
  const auto is_good = [&](const AxisTask& task) {
    return is_precise(task, options.goal, scaled(leader.profile, line->share(task)));
  };
  if (!std::ranges::all_of(tasks, is_good)) return std::nullopt;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    planned[i].profile = scaled(leader.profile, line->share(tasks[i]));
    planned[i].duration = leader.duration;
  }
  return leader.duration;
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
    if (const auto done = plan_axis(tasks[i], options.goal, 0.0, planned[i]); !done) {
      return std::unexpected{Refused{.axis = i, .defect = done.error()}};
    }
    planned[i].shortest = planned[i].duration;
    longest = std::max(longest, planned[i].shortest);
  }
  if (options.synchronisation == Synchronisation::phase) {
    if (const auto duration = plan_line(tasks, options, planned)) return *duration;
  }
  const auto duration = options.synchronisation == Synchronisation::none
                            ? plan_apart(tasks, options.goal, options.minimum_duration, planned)
                            : plan_together(tasks, options.goal, longest, planned);
  if (!duration) return duration;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (!is_precise(tasks[i], options.goal, planned[i].profile)) {
      return std::unexpected{Refused{.axis = i, .defect = Defect::precision}};
    }
  }
  return duration;
}

}  // namespace takt::motion
