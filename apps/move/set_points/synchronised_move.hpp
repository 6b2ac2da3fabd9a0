#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "apps/move/set_points/motion_limits.hpp"
#include "master/motion/trajectory.hpp"

namespace takt {

/// A jerk-limited move of all axes along the straight line from one point to another. The axes
/// start together and arrive together, and each axis stays within its own limits.
class SynchronisedMove {
 public:
  /// Plans the move. `limits` holds the limits of each axis. Returns std::nullopt if
  /// plan_trajectory() refuses it.
  static std::optional<SynchronisedMove> plan(const Eigen::VectorXd& from,
                                              const Eigen::VectorXd& to,
                                              std::span<const MotionLimits> limits);

  double duration() const noexcept { return duration_; }
  Eigen::VectorXd position(double seconds) const;

 private:
  std::vector<motion::AxisTask> tasks_;
  std::vector<motion::PlannedAxis> planned_;
  double duration_ = 0.0;
};

}  // namespace takt
