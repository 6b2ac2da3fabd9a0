#pragma once
#include <cstdint>
#include <expected>
#include <span>

#include "master/motion/straight_line.hpp"

namespace takt::motion {

/// How the motions of several axes belong together.
enum class Synchronisation : std::uint8_t {
  none,   ///< each axis takes its shortest time
  time,   ///< all axes arrive at the same time
  phase,  ///< all axes move on one straight line; the same as `time` if there is none
};

/// What is wrong with the task of an axis.
enum class Defect : std::uint8_t {
  not_finite,              ///< a number is infinite or NaN
  velocity_limits,         ///< min_velocity < 0 < max_velocity does not hold
  acceleration_limits,     ///< min_acceleration < 0 < max_acceleration does not hold
  jerk_limit,              ///< jerk is not positive
  target_velocity,         ///< outside the limits
  target_acceleration,     ///< outside the limits
  velocity_before_target,  ///< the target's acceleration needs a velocity before it that is outside
  position_range,          ///< every motion that was tried leaves the range
};

/// A task that has no motion.
struct Refused {
  std::size_t axis = 0;  ///< number of the task
  Defect defect{};
};

/// Returns the defect of a task, if it has one.
std::expected<void, Defect> defect_of(const AxisTask& task) noexcept;

/// The motion of one axis as it was planned.
struct PlannedAxis {
  Profile profile;
  double duration = 0.0;  ///< s
  double shortest = 0.0;  ///< duration that the axis would need without the others, in s
};

struct TrajectoryOptions {
  Goal goal = Goal::position;
  Synchronisation synchronisation = Synchronisation::time;
  double minimum_duration = 0.0;  ///< s
};

/// Plans the motion of all tasks, the shortest that the options allow. Where it leaves the range of
/// positions, longer ones are tried. Writes one motion for each task to `planned`, which must be as
/// long as `tasks`. Returns the duration of the longest one in s. It never allocates.
std::expected<double, Refused> plan_trajectory(std::span<const AxisTask> tasks,
                                               const TrajectoryOptions& options,
                                               std::span<PlannedAxis> planned) noexcept;

}  // namespace takt::motion
