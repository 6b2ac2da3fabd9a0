#pragma once
#include <Eigen/Core>

#include "apps/move/jerk_limited.hpp"

namespace takt {

/// A jerk-limited move of all axes along the straight line from one point to another: they start
/// together, arrive together, and each stays within the limits.
class SynchronisedMove {
 public:
  SynchronisedMove(Eigen::VectorXd from, Eigen::VectorXd to, const MotionLimits& limits);

  double duration() const noexcept { return profile_.duration(); }
  Eigen::VectorXd position(double seconds) const;
  Eigen::VectorXd velocity(double seconds) const;

 private:
  Eigen::VectorXd from_;
  Eigen::VectorXd to_;
  double longest_;       // distance of the axis that has farthest to go
  JerkLimited profile_;  // of that axis; the others move in proportion
};

}  // namespace takt
