#include "apps/move/sine.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

namespace takt {
namespace {

/// 0 to 1 with velocity and acceleration zero at both ends.
double smooth(double x) noexcept {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10.0 + x * (6.0 * x - 15.0));
}

}  // namespace

Sine::Sine(Eigen::VectorXd centre, const Shape& shape) : centre_{std::move(centre)}, shape_{shape} {
  shape_.duration = std::max(shape.duration, 2.0 / shape.frequency);
  const auto axes = centre_.size();
  phase_ = Eigen::VectorXd::LinSpaced(axes, 0.0, static_cast<double>(axes - 1)) *
           (2.0 * std::numbers::pi / static_cast<double>(std::max<Eigen::Index>(axes, 1)));
}

Eigen::VectorXd Sine::position(double seconds) const {
  const double fade =
      smooth(seconds * shape_.frequency) * smooth((shape_.duration - seconds) * shape_.frequency);
  const double angle = 2.0 * std::numbers::pi * shape_.frequency * seconds;
  return centre_.array() + shape_.amplitude * fade * (phase_.array() + angle).sin();
}

}  // namespace takt
