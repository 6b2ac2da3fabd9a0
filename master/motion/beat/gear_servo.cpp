#include "master/motion/beat/gear_servo.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace takt::motion {
namespace {

/// Returns the acceleration after the next step with which the velocity reaches `end` soonest. In
/// each later step, the size of the acceleration falls by at most `step`, until it is 0.
double acceleration_to(double end, const State& from, double step, double period) noexcept {
  const double change = (end - from.velocity) / period - from.acceleration / 2;
  const double size = std::abs(change);
  const double steps = std::floor((std::sqrt(1.0 + 8.0 * size / step) - 1.0) / 2);
  return std::copysign((size + step * steps * (steps + 1.0) / 2) / (steps + 1.0), change);
}

/// Returns the velocity of an axis after its acceleration has fallen to 0, by at most `step` in
/// each step.
double velocity_after_fall(const State& from, double step, double period) noexcept {
  const double size = std::abs(from.acceleration);
  const double steps = std::floor(size / step);
  const double gain = size / 2 + steps * size - step * steps * (steps + 1.0) / 2;
  return from.velocity + std::copysign(gain * period, from.acceleration);
}

State step_with(const State& from, double acceleration, double period) noexcept {
  return advanced(from, period, (acceleration - from.acceleration) / period);
}

/// Returns the jerks of the three steps that bring an axis exactly to its target. The target has
/// the state `before` at the time of `from`, and a constant jerk.
std::array<double, 3> three_steps(const State& from, const State& before, double target_jerk,
                                  double period) noexcept {
  const double cube = period * period * period;
  const double p = (from.position - before.position) / cube;
  const double v = (from.velocity - before.velocity) * period / cube;
  const double a = (from.acceleration - before.acceleration) * period * period / cube;
  return {target_jerk - p - 2 * v - 11.0 / 6.0 * a, target_jerk + 2 * p + 3 * v + 7.0 / 6.0 * a,
          target_jerk - p - v - a / 3.0};
}

}  // namespace

/// Returns the accelerations that the axis may have after the next step. The limit of jerk is
/// always kept, even if the axis begins outside its other limits.
GearServo::Room GearServo::room_after(const State& from, double period) const noexcept {
  const double step = limits_.jerk * period;
  const double high = acceleration_to(limits_.max_velocity, from, step, period);
  const double low = acceleration_to(limits_.min_velocity, from, step, period);
  const auto reachable = [&](double acceleration) {
    const double allowed =
        std::clamp(acceleration, limits_.min_acceleration, limits_.max_acceleration);
    return std::clamp(allowed, from.acceleration - step, from.acceleration + step);
  };
  const Room room{.min = reachable(low), .max = reachable(high)};
  return {.min = std::min(room.min, room.max), .max = room.max};
}

/// Returns the distance that an axis covers until both its velocity and its acceleration are 0.
/// The axis is mirrored so that it has to brake, as in stop_profile().
double GearServo::distance_to_settle(double velocity, double acceleration) const noexcept {
  const double jerk = jerk_for_settling * limits_.jerk;
  const double coasting = velocity + acceleration * std::abs(acceleration) / (2 * jerk);
  const double sign = coasting < 0.0 ? -1.0 : 1.0;
  const double limit = coasting < 0.0 ? limits_.max_acceleration : -limits_.min_acceleration;
  const double most = acceleration_for_settling * limit;
  double v = sign * velocity;
  double a = sign * acceleration;
  double distance = 0.0;
  if (a < -most) {
    const double time = (-most - a) / jerk;
    distance = time * (v + time * (a / 2 + time * jerk / 6));
    v += time * (a - most) / 2;
    a = -most;
  }
  const double square = std::max(jerk * v + a * a / 2, 0.0);
  const double peak = std::min(std::sqrt(square), most);
  const double fall = (a + peak) / jerk;
  distance += fall * (v + fall * (a / 2 - fall * jerk / 6));
  if (peak == most) {
    const double hold = (square - peak * peak) / (jerk * most);
    distance += hold * (v + (a * a - peak * peak) / (2 * jerk) - most * hold / 2);
  }
  return sign * (distance + peak * peak * peak / (6 * jerk * jerk));
}

/// Returns the acceleration after the next step of a catch-up. The distance that would remain at
/// the end of the catch-up is a rising function of this acceleration. The secant method finds the
/// acceleration within `room` for which this distance is 0.
double GearServo::catching_up(const State& from, const State& target, const Room& room,
                              double period) const noexcept {
  const double jerk = jerk_for_settling * limits_.jerk;
  const double ease = std::abs(target.acceleration) / jerk;
  const double end = std::clamp(target.velocity + target.acceleration * ease / 2,
                                limits_.min_velocity, limits_.max_velocity);
  const double way = ease * (target.velocity - end + target.acceleration * ease / 3);
  const auto remaining = [&](double acceleration) {
    const State next = step_with(from, acceleration, period);
    return next.position - target.position - way +
           distance_to_settle(next.velocity - end, next.acceleration);
  };
  double high = room.max;
  double above = remaining(high);
  if (above <= 0.0) return high;
  double low = room.min;
  double below = remaining(low);
  if (below >= 0.0) return low;
  const double enough = 1e-4 * limits_.jerk * period * period * period;
  double found = low;
  double last = 0.0;
  for (int i = 0; i < most_trials; ++i) {
    found = (low * above - high * below) / (above - below);
    const double error = remaining(found);
    if (std::abs(error) <= enough) break;
    // If the same end of the bracket is kept twice in a row, its weight is halved.
    if (error > 0.0) {
      high = found;
      above = error;
      if (last > 0.0) below /= 2;
    } else {
      low = found;
      below = error;
      if (last < 0.0) above /= 2;
    }
    last = error;
  }
  return found;
}

/// Returns true if the target uses almost the whole jerk, and the axis is close to it. Little jerk
/// is then left for corrections. They have to wait, because the axis would fall far behind if it
/// used the jerk for them.
bool GearServo::is_led(const State& from, const State& before, double target_jerk,
                       double period) const noexcept {
  constexpr double whole = 0.8;
  constexpr double closeness = 50.0;
  const double step = limits_.jerk * period;
  return std::abs(target_jerk) > whole * limits_.jerk &&
         std::abs(before.acceleration - from.acceleration) <= step &&
         std::abs(before.velocity - from.velocity) <= step * period &&
         std::abs(before.position - from.position) <= closeness * step * period * period;
}

State GearServo::step_to_position(const State& from, const State& target, double target_jerk,
                                  double period) const noexcept {
  const Room room = room_after(from, period);
  const State before = advanced(target, -period, target_jerk);
  const std::array jerks = three_steps(from, before, target_jerk, period);
  const double first = from.acceleration + jerks[0] * period;
  const double second = first + jerks[1] * period;
  // Rounding must not end the exact steps of an axis that follows at one of its limits.
  constexpr double slack = 1e-3;
  const double rounding = slack * limits_.jerk * period;
  const double most = (1.0 + slack) * limits_.jerk;
  const bool is_near = first >= room.min - rounding && first <= room.max + rounding &&
                       second >= limits_.min_acceleration - rounding &&
                       second <= limits_.max_acceleration + rounding &&
                       std::abs(jerks[1]) <= most && std::abs(jerks[2]) <= most;
  double next = 0.0;
  if (is_near) {
    next = std::clamp(first, room.min, room.max);
  } else if (is_led(from, before, target_jerk, period)) {
    next = std::clamp(target.acceleration, room.min, room.max);
  } else {
    next = catching_up(from, target, room, period);
  }
  return step_with(from, next, period);
}

State GearServo::step_to_velocity(const State& from, const State& target,
                                  double period) const noexcept {
  const double step = limits_.jerk * period;
  const double end = velocity_after_fall(target, step, period);
  const double wanted = acceleration_to(end, from, step, period);
  const Room room = room_after(from, period);
  return step_with(from, std::clamp(wanted, room.min, room.max), period);
}

State GearServo::step_to_cruise(const State& from, double period) const noexcept {
  const Room room = room_after(from, period);
  return step_with(from, std::clamp(0.0, room.min, room.max), period);
}

}  // namespace takt::motion
