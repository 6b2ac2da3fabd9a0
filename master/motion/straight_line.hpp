#pragma once
#include <cstddef>
#include <optional>
#include <span>

#include "master/motion/axis_motion.hpp"
#include "master/motion/position_range.hpp"

namespace takt::motion {

/// What one axis shall do.
struct AxisTask {
  State from;
  State to;
  Limits limits;
  PositionRange range{};  ///< of the whole motion
};

/// Axes that can move on a straight line of the space of all axes, as one axis with limits that no
/// axis exceeds.
class StraightLine {
 public:
  /// Returns the line of these tasks. Empty if their displacements, velocities and accelerations do
  /// not all have one direction.
  static std::optional<StraightLine> find(std::span<const AxisTask> tasks, Goal goal) noexcept;

  /// Returns the axis that represents all axes. Its limits are reduced so that no axis exceeds its
  /// own.
  const AxisTask& leader() const noexcept { return leader_; }

  /// Returns the part of the leader's motion that the axis of `task` makes, negative for the other
  /// direction.
  double share(const AxisTask& task) const noexcept;

 private:
  /// The quantity that gives the direction.
  using Quantity = double (*)(const AxisTask&);

  StraightLine(const AxisTask& leader, Quantity direction) noexcept
      : leader_{leader}, direction_{direction}, size_{direction(leader)} {}

  AxisTask leader_;
  Quantity direction_;
  double size_;  ///< of the leader
};

}  // namespace takt::motion
