#pragma once
#include <Eigen/Core>

#include "apps/move/set_points/motion_limits.hpp"

namespace takt {

/// A sine around a point. The axes are shifted in phase against each other. The amplitude grows
/// from zero and returns to zero, each over one period or over half of the duration if that is
/// less, so that the motion starts and ends at rest at the centre.
class Sine {
 public:
  struct Shape {
    Eigen::VectorXd amplitude;  ///< one for each axis, in the unit of the axis
    double frequency = 0.5;     ///< Hz
    double duration = 10.0;     ///< s; a duration below one period becomes one period
  };

  Sine(Eigen::VectorXd centre, const Shape& shape);

  double duration() const noexcept { return shape_.duration; }
  /// Returns the largest amplitude that keeps an axis within these limits.
  double amplitude_within(const MotionLimits& limits) const;
  void set_amplitude(Eigen::Index axis, double amplitude) { shape_.amplitude(axis) = amplitude; }
  Eigen::VectorXd position(double seconds) const;

 private:
  double fade_seconds() const noexcept;

  Eigen::VectorXd centre_;
  Eigen::VectorXd phase_;  // rad
  Shape shape_;
};

}  // namespace takt
