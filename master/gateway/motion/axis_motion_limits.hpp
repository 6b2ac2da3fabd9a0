#pragma once
#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <takt/motion_goal_t.hpp>
#include <vector>

#include "eds_parser/table/motion_axes.hpp"
#include "master/motion/limits.hpp"
#include "master/motion/position_range.hpp"

namespace takt {

/// The limits of the motions of each axis: those of the network file, those that the master has
/// read from the drive in its boot, and narrower ones of a command.
class AxisMotionLimits {
 public:
  /// Limits and targets must lie between these magnitudes, in the unit of the axis. They keep the
  /// planner inside the range in which it computes exactly.
  static constexpr double smallest = 1e-9;
  static constexpr double largest = 1e12;

  explicit AxisMotionLimits(const BusPlan& plan);

  /// Takes a limit that the master has read from a drive; motions keep it from now on. `line` is an
  /// index into LimitsPlan::lines, `value` is the value of its object. For a range, the lower end
  /// is in the upper half of `value`.
  void learn(const BusPlan& plan, std::size_t line, std::int64_t value);
  /// Returns the limits of a motion. The error says why a limit is missing or was refused. `axis`
  /// is an index into motion_axes().
  std::expected<motion::Limits, std::string> of(std::size_t axis, const motion_goal_t& goal) const;
  /// Returns the largest following error of a motion; infinite if neither the command nor the file
  /// limits it. The error says why the command is refused.
  std::expected<double, std::string> following_error(std::size_t axis,
                                                     const motion_goal_t& goal) const;
  /// Returns the range of positions of the axis. The range is unlimited if the axis is rotary and
  /// its range is not shorter than its turn.
  const motion::PositionRange& range(std::size_t axis) const noexcept { return axes_[axis].range; }
  /// Returns the length of a turn if the axis is rotary and its range is not shorter than its turn,
  /// in the unit of the axis; otherwise 0.
  double turn(std::size_t axis) const noexcept { return axes_[axis].turn; }

 private:
  struct Axis {
    std::optional<double> velocity{};
    std::optional<double> step_velocity{};  ///< velocity that keeps the limit of the step
    std::optional<double> acceleration{};
    std::optional<double> jerk{};
    std::optional<double> following_error{};
    motion::PositionRange range{};
    double turn = 0.0;
  };
  void add(const BusPlan& plan, const LimitLine& line);

  std::vector<MotionAxis> signals_;
  std::vector<Axis> axes_;
};

}  // namespace takt
