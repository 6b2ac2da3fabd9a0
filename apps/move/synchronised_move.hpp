#pragma once
#include <Eigen/Core>
#include <span>

#include "apps/move/jerk_limited.hpp"

namespace takt {

/// A jerk-limited move of all axes along the straight line from one point to another: they start
/// together, arrive together, and each stays within its own limits.
class SynchronisedMove {
 public:
  /// `limits`: one an axis.
  SynchronisedMove(Eigen::VectorXd from, Eigen::VectorXd to, std::span<const MotionLimits> limits);

  double duration() const noexcept { return profile_.duration(); }
  Eigen::VectorXd position(double seconds) const;
  Eigen::VectorXd velocity(double seconds) const;

 private:
  Eigen::VectorXd from_;
  Eigen::VectorXd to_;
  JerkLimited profile_;  // of the share of the way, 0 to 1
};

}  // namespace takt
