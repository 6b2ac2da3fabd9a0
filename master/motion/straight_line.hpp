#pragma once
#include <optional>
#include <span>

#include "master/motion/axis_motion.hpp"
#include "master/motion/position_range.hpp"

namespace takt::motion {

/// The task of one axis: its start, its target and its limits.
struct AxisTask {
  State from;
  State to;
  Limits limits;
  PositionRange range{};  ///< range of all positions during the motion
};

/// A motion of several axes on a straight line in the space of all axes. One axis, the leader,
/// represents them all. Its limits are so low that no axis exceeds its own limits.
class StraightLine {
 public:
  /// Returns the line of these tasks. Returns std::nullopt if nothing moves, or if their
  /// displacements, velocities and accelerations do not all have the same direction.
  static std::optional<StraightLine> find(std::span<const AxisTask> tasks, Goal goal) noexcept;

  /// Returns the task of the leader with the reduced limits and the reduced range.
  const AxisTask& leader() const noexcept { return leader_; }

  /// Returns the factor between the motion of the leader and that of the axis of `task`. It is
  /// negative if the axis moves in the opposite direction.
  double share(const AxisTask& task) const noexcept;

 private:
  /// A function that returns the quantity of a task that gives the direction of the line, such as
  /// its displacement.
  using Quantity = double (*)(const AxisTask&);

  StraightLine(const AxisTask& leader, Quantity direction) noexcept
      : leader_{leader}, direction_{direction}, size_{direction(leader)} {}

  AxisTask leader_;
  Quantity direction_;
  double size_;  ///< value of this quantity for the leader
};

}  // namespace takt::motion
