#pragma once
#include <algorithm>
#include <cmath>

namespace takt::sim {

/// Set-point of the drive's control loop, in user units and user units per second.
struct Demand {
  double position = 0;
  double velocity = 0;
};

/// Velocity (user units per second) and accelerations (user units per second squared) of a profile;
/// all positive.
struct Ramps {
  double velocity = 0;
  double acceleration = 0;
  double deceleration = 0;
};

/// Moves the demanded velocity towards `target` for `h` seconds.
inline void ramp_velocity(Demand& demand, double target, const Ramps& ramps, double h) noexcept {
  const double old = demand.velocity;
  const bool slower = std::abs(target) < std::abs(old) || target * old < 0;
  const double step = (slower ? ramps.deceleration : ramps.acceleration) * h;
  demand.velocity = std::clamp(target, old - step, old + step);
  demand.position += (old + demand.velocity) / 2 * h;
}

/// Makes one step of `h` seconds on a trapezoidal profile towards `target`. Returns true when the
/// demand has reached the target and is at rest.
inline bool approach(Demand& demand, double target, const Ramps& ramps, double h) noexcept {
  const double way = target - demand.position;
  const double half = ramps.deceleration * h / 2;
  const double still = std::sqrt(half * half + 2 * ramps.deceleration * std::abs(way)) - half;
  const double allowed = std::copysign(std::min(still, ramps.velocity), way);
  if (std::abs(way) <= std::max(0.5, std::abs(demand.velocity) * h) &&
      std::abs(demand.velocity) <= 2 * ramps.deceleration * h) {
    demand = {target, 0};
    return true;
  }
  ramp_velocity(demand, allowed, ramps, h);
  return false;
}

/// A motor with its load under velocity and position control. The velocity has a first-order lag,
/// the position a second-order lag.
class Motor {
 public:
  double position = 0;
  double velocity = 0;
  double acceleration = 0;

  /// `demand` is the set-point at the end of the step.
  void follow_position(const Demand& demand, double limit, double h) noexcept {
    const double error = demand.position - (position + velocity * h);
    follow_velocity(demand.velocity + position_gain * error, limit, h);
  }
  void follow_velocity(double target, double limit, double h) noexcept {
    const double wanted = (velocity * lag + target * h) / (lag + h);
    move(std::clamp(wanted, velocity - limit * h, velocity + limit * h), h);
  }
  /// Lets friction bring the motor to rest, without power.
  void coast(double friction, double h) noexcept {
    const double lost = std::min(std::abs(velocity), friction * h);
    move(velocity - std::copysign(lost, velocity), h);
  }
  bool stands() const noexcept { return velocity == 0; }

 private:
  static constexpr double lag = 0.001;           // s
  static constexpr double position_gain = 80.0;  // 1/s

  void move(double next, double h) noexcept {
    acceleration = (next - velocity) / h;
    position += (velocity + next) / 2 * h;
    velocity = next;
  }
};

}  // namespace takt::sim
