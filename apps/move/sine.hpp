#pragma once
#include <Eigen/Core>

namespace takt {

/// A sine around a point, the axes shifted in phase against each other; its amplitude grows from
/// zero and returns to zero over one period each, so that it starts and ends at rest at the centre.
class Sine {
 public:
  struct Shape {
    double amplitude = 0.2;  ///< unit of the axis
    double frequency = 0.5;  ///< Hz
    double duration = 10.0;  ///< s, at least two periods; shorter ones are stretched
  };

  Sine(Eigen::VectorXd centre, const Shape& shape);

  double duration() const noexcept { return shape_.duration; }
  Eigen::VectorXd position(double seconds) const;

 private:
  Eigen::VectorXd centre_;
  Eigen::VectorXd phase_;  // rad
  Shape shape_;
};

}  // namespace takt
