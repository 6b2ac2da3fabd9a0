#pragma once
#include <Eigen/Core>
#include <span>

#include "apps/move/jerk_limited.hpp"

namespace takt {

/// A jerk-limited move of all axes along the straight line from one point to another. The axes
/// start together and arrive together, and each axis stays within its own limits.
class SynchronisedMove {
 public:
  /// `limits` holds the limits of each axis.
  SynchronisedMove(Eigen::VectorXd from, Eigen::VectorXd to, std::span<const MotionLimits> limits);

  double duration() const noexcept { return profile_.duration(); }
  Eigen::VectorXd position(double seconds) const;
  Eigen::VectorXd velocity(double seconds) const;

 private:
  Eigen::VectorXd from_;
  Eigen::VectorXd to_;
  JerkLimited profile_;  // the covered share of the way, 0 to 1
};

}  // namespace takt
