#include "apps/move/set_points/sine.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace takt {
namespace {

/// A function that rises from 0 to 1 with first and second derivative zero at both ends, and its
/// derivatives.
struct Fade {
  double value;
  double first;
  double second;
  double third;
};

Fade fade_at(double x) noexcept {
  x = std::clamp(x, 0.0, 1.0);
  return {.value = x * x * x * (10.0 + x * (6.0 * x - 15.0)),
          .first = 30.0 * x * x * (1.0 - x) * (1.0 - x),
          .second = 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x),
          .third = 60.0 - 360.0 * x * (1.0 - x)};
}

/// Returns the highest velocity, acceleration and jerk of a sine of amplitude 1, 1 rad/s and any
/// phase that fades in over `angle` rad.
MotionLimits peaks(double angle) noexcept {
  constexpr int steps = 256;
  MotionLimits peak{.velocity = 1.0, .acceleration = 1.0, .jerk = 1.0};
  for (int i = 0; i <= steps; ++i) {
    const Fade fade = fade_at(static_cast<double>(i) / steps);
    const double first = fade.first / angle;
    const double second = fade.second / (angle * angle);
    const double third = fade.third / (angle * angle * angle);
    peak.velocity = std::max(peak.velocity, std::hypot(fade.value, first));
    peak.acceleration = std::max(peak.acceleration, std::hypot(second - fade.value, 2.0 * first));
    peak.jerk = std::max(peak.jerk, std::hypot(third - 3.0 * first, 3.0 * second - fade.value));
  }
  return peak;
}

}  // namespace

Sine::Sine(Eigen::VectorXd centre, const Shape& shape) : centre_{std::move(centre)}, shape_{shape} {
  shape_.duration = std::max(shape.duration, 1.0 / shape.frequency);
  const auto axes = centre_.size();
  phase_ = Eigen::VectorXd::LinSpaced(axes, 0.0, static_cast<double>(axes - 1)) *
           (2.0 * std::numbers::pi / static_cast<double>(std::max<Eigen::Index>(axes, 1)));
}

double Sine::fade_seconds() const noexcept {
  return std::min(1.0 / shape_.frequency, shape_.duration / 2.0);
}

double Sine::amplitude_within(const MotionLimits& limits) const {
  const double turn = 2.0 * std::numbers::pi * shape_.frequency;  // rad/s
  const MotionLimits peak = peaks(turn * fade_seconds());
  return std::min({limits.velocity / (turn * peak.velocity),
                   limits.acceleration / (turn * turn * peak.acceleration),
                   limits.jerk / (turn * turn * turn * peak.jerk)});
}

Eigen::VectorXd Sine::position(double seconds) const {
  const double fade = fade_at(seconds / fade_seconds()).value *
                      fade_at((shape_.duration - seconds) / fade_seconds()).value;
  const double angle = 2.0 * std::numbers::pi * shape_.frequency * seconds;
  return centre_.array() + fade * shape_.amplitude.array() * (phase_.array() + angle).sin();
}

}  // namespace takt
