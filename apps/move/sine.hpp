#pragma once
#include <Eigen/Core>

#include "apps/move/jerk_limited.hpp"

namespace takt {

/// A sine around a point, the axes shifted in phase against each other; its amplitude grows from
/// zero and returns to zero over one period each, or over half of the time where that is less, so
/// that it starts and ends at rest at the centre.
class Sine {
 public:
  struct Shape {
    Eigen::VectorXd amplitude;  ///< one an axis, in its unit
    double frequency = 0.5;     ///< Hz
    double duration = 10.0;     ///< s, at least one period; shorter ones are stretched
  };

  Sine(Eigen::VectorXd centre, const Shape& shape);

  double duration() const noexcept { return shape_.duration; }
  /// The largest amplitude that keeps an axis within these limits.
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
