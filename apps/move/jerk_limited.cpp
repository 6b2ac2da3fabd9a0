#include "apps/move/jerk_limited.hpp"

#include <algorithm>
#include <cmath>

namespace takt {
namespace {

/// Durations of one jerk segment and of the whole ramp from rest to a velocity.
struct Ramp {
  double jerk_time;
  double time;
};

Ramp ramp_to(double velocity, const MotionLimits& limits) noexcept {
  const double full = limits.acceleration / limits.jerk;  // time to the full acceleration
  if (velocity >= limits.acceleration * full) {
    return {full, velocity / limits.acceleration + full};
  }
  const double jerk_time = std::sqrt(velocity / limits.jerk);
  return {jerk_time, 2.0 * jerk_time};
}

/// Returns the velocity at which a ramp up and a ramp down together cover `distance`.
double peak_velocity(double distance, const MotionLimits& limits) noexcept {
  const double full = limits.acceleration / limits.jerk;
  const double a = limits.acceleration;
  // distance = v * (v / a + full)
  const double velocity = (std::sqrt(a * a * full * full + 4.0 * a * distance) - a * full) / 2.0;
  if (velocity >= a * full) return velocity;
  const double jerk_time = std::cbrt(distance / (2.0 * limits.jerk));
  return limits.jerk * jerk_time * jerk_time;
}

}  // namespace

JerkLimited::JerkLimited(double distance, const MotionLimits& limits) noexcept
    : distance_{distance}, jerk_{limits.jerk} {
  if (!(distance > 0.0)) return;
  const double velocity = std::min(limits.velocity, peak_velocity(distance, limits));
  const Ramp ramp = ramp_to(velocity, limits);
  jerk_time_ = ramp.jerk_time;
  ramp_ = ramp.time;
  cruise_ = std::max(0.0, distance / velocity - ramp_);
}

MotionPoint JerkLimited::at(double seconds) const noexcept {
  if (!(distance_ > 0.0) || seconds >= duration()) return {distance_, 0.0, 0.0};
  if (seconds <= 0.0) return {};
  if (seconds <= duration() / 2.0) return speeding_up(seconds);
  const MotionPoint mirrored = speeding_up(duration() - seconds);
  return {distance_ - mirrored.position, mirrored.velocity, -mirrored.acceleration};
}

MotionPoint JerkLimited::speeding_up(double seconds) const noexcept {
  MotionPoint point;
  double left = seconds;
  const auto go = [&](double jerk, double segment) {
    const double t = std::clamp(left, 0.0, segment);
    point.position += t * (point.velocity + t * (point.acceleration / 2.0 + t * jerk / 6.0));
    point.velocity += t * (point.acceleration + t * jerk / 2.0);
    point.acceleration += t * jerk;
    left -= t;
  };
  go(jerk_, jerk_time_);
  go(0.0, ramp_ - 2.0 * jerk_time_);
  go(-jerk_, jerk_time_);
  if (seconds >= ramp_) point.acceleration = 0.0;  // removes the rounding error
  go(0.0, cruise_);
  return point;
}

}  // namespace takt
