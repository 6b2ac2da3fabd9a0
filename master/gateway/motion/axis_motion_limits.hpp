#pragma once
#include <cstddef>
#include <expected>
#include <optional>
#include <string>
#include <takt/motion_goal_t.hpp>
#include <vector>

#include "eds_parser/table/motion_axes.hpp"
#include "master/motion/limits.hpp"
#include "master/motion/position_range.hpp"

namespace takt {

/// The limits of the motions of each axis: those of the network file, and narrower ones of a
/// command.
class AxisMotionLimits {
 public:
  /// Limits and targets must lie between these magnitudes, in the unit of the axis. They keep the
  /// planner inside the range in which it computes exactly.
  static constexpr double smallest = 1e-9;
  static constexpr double largest = 1e12;

  explicit AxisMotionLimits(const BusPlan& plan);

  /// Returns the limits of a motion, or why there are none. `axis` is a position in motion_axes().
  std::expected<motion::Limits, std::string> of(std::size_t axis, const motion_goal_t& goal) const;
  /// Returns the largest following error of a motion, or why there is none; infinite if neither the
  /// command nor the file has one.
  std::expected<double, std::string> following_error(std::size_t axis,
                                                     const motion_goal_t& goal) const;
  const motion::PositionRange& range(std::size_t axis) const noexcept { return axes_[axis].range; }

 private:
  struct Axis {
    std::optional<double> velocity{};
    std::optional<double> acceleration{};
    std::optional<double> jerk{};
    std::optional<double> following_error{};
    motion::PositionRange range{};
  };
  static Axis limits_of(const BusPlan& plan, const MotionAxis& axis);

  std::vector<Axis> axes_;
};

}  // namespace takt
