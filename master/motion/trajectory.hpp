#pragma once
#include <cstdint>
#include <expected>
#include <span>

#include "master/motion/straight_line.hpp"

namespace takt::motion {

/// The synchronisation of the motions of several axes.
enum class Synchronisation : std::uint8_t {
  none,   ///< each axis takes its shortest time
  time,   ///< all axes arrive at the same time
  phase,  ///< all axes move on one straight line; if this is impossible, the same as `time`
};

/// The reason why an axis can't do its task.
enum class Defect : std::uint8_t {
  not_finite,              ///< a number of the task or of its motion is infinite or NaN
  velocity_limits,         ///< min_velocity < 0 < max_velocity does not hold
  acceleration_limits,     ///< min_acceleration < 0 < max_acceleration does not hold
  jerk_limit,              ///< jerk is not positive
  target_velocity,         ///< the target velocity is outside the limits
  target_acceleration,     ///< the target acceleration is outside the limits
  velocity_before_target,  ///< just before the target, the velocity would have to be outside the
                           ///< limits
  position_range,          ///< all motions that were tried leave the range of positions
  common_duration,         ///< no duration was found that is possible for all axes
  precision,               ///< the numbers have too few digits for this motion, see is_precise()
};

/// A task for which there is no motion, and the reason.
struct Refused {
  std::size_t axis = 0;  ///< index of the task
  Defect defect{};
};

/// Checks the limits and the target of a task. The error is its first defect.
std::expected<void, Defect> defect_of(const AxisTask& task) noexcept;

/// The planned motion of one axis.
struct PlannedAxis {
  Profile profile;
  double duration = 0.0;  ///< s
  double shortest = 0.0;  ///< shortest duration of this axis without regard to the other axes, in s
};

struct TrajectoryOptions {
  Goal goal = Goal::position;
  Synchronisation synchronisation = Synchronisation::time;
  double minimum_duration = 0.0;  ///< s
};

/// Plans the shortest motions of all tasks that the options permit. If a motion leaves the range of
/// positions of its axis, longer motions are tried. Writes one motion for each task to `planned`,
/// which must have as many elements as `tasks`. Returns the duration of the longest motion in s.
/// The function allocates no memory.
std::expected<double, Refused> plan_trajectory(std::span<const AxisTask> tasks,
                                               const TrajectoryOptions& options,
                                               std::span<PlannedAxis> planned) noexcept;

}  // namespace takt::motion
