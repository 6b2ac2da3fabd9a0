#include "master/sim/mechanics/servo.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace takt::sim {
namespace {

double seconds(Time time) noexcept { return static_cast<double>(time.count()) * 1e-9; }

}  // namespace

Servo::Servo(const MechanicsTable& table) noexcept
    : plant_{table},
      encoder_{table},
      cascade_{table, plant_.inertia()},
      brake_{table.brake},
      counts_per_radian_{table.turn / (2 * std::numbers::pi)},
      current_step_{1 - std::exp(-mechanics_tick / table.motor.current_lag)},
      fastest_{table.motor.max_speed} {}

void Servo::reset(Time now) noexcept {
  last_ = {};
  torque_ = wanted_ = 0;
  holds_ = false;
  cascade_.reset();
  time_ = run_until_ = now;
}

void Servo::shift(double counts) noexcept {
  origin_ += counts;
  last_.position += counts;
}

void Servo::set_stops(double low, double high) noexcept {
  plant_.set_stops(angle(low), angle(high));
}

double Servo::reported(Time now) const noexcept {
  return counts(encoder_.reported(seconds(now - time_), plant_.motor().speed));
}

bool Servo::rests() const noexcept {
  return last_.loop == ServoLoop::off && !holds_ && torque_ == 0 && encoder_.speed() == 0 &&
         plant_.stands() && (!brake_.exists() || brake_.is_closed());
}

void Servo::run(const ServoReference& next, const ServoLimits& limits, Time until) noexcept {
  if (next.loop != last_.loop) begin(next.loop);
  Goal goal{.loop = next.loop,
            .speed = next.velocity / counts_per_radian_,
            .speed_add = next.velocity_add / counts_per_radian_,
            .torque = next.torque};
  const double first = angle((next.loop == last_.loop ? last_ : next).position);
  const double way = angle(next.position) - first;
  const double per_second = until > run_until_ ? 1 / seconds(until - run_until_) : 0;
  while (time_ + tick <= until) {
    time_ += tick;
    goal.angle = first + way * (seconds(time_ - run_until_) * per_second);
    step(goal, limits);
  }
  last_ = next;
  run_until_ = until;
}

void Servo::begin(ServoLoop loop) noexcept {
  const bool was_off = last_.loop == ServoLoop::off && !holds_;
  holds_ = loop == ServoLoop::off && brake_.exists() && stands();
  held_ = encoder_.angle();
  if (was_off || (loop == ServoLoop::off && !holds_)) cascade_.reset();
}

void Servo::step(const Goal& goal, const ServoLimits& limits) noexcept {
  const bool powered = goal.loop != ServoLoop::off;
  brake_.advance(powered);
  if (holds_ && brake_.is_closed()) holds_ = false;
  encoder_.sample(plant_.motor().angle);
  if (powered || holds_) {
    wanted_ = torque_for(goal, limits);
    torque_ += current_step_ * (wanted_ - torque_);
  } else {
    wanted_ = torque_ = 0;
    cascade_.set_limited(false);
  }
  plant_.advance(torque_, brake_.torque());
}

double Servo::torque_for(const Goal& goal, const ServoLimits& limits) noexcept {
  switch (goal.loop) {
    case ServoLoop::off:
    case ServoLoop::hold:
      return torque_at({.angle = held_}, limits);
    case ServoLoop::position:
      return torque_at(goal, limits);
    case ServoLoop::velocity: {
      const double wanted = std::clamp(goal.speed, -limits.speed, limits.speed);
      return cascade_.torque_for(wanted - encoder_.speed(), goal.torque, available(limits),
                                 wanted == 0 && encoder_.speed() == 0);
    }
    case ServoLoop::torque: {
      const double torque = available(limits).clamp(goal.torque);
      cascade_.set_limited(torque != goal.torque);
      return torque;
    }
  }
  return 0;
}

double Servo::torque_at(const Goal& goal, const ServoLimits& limits) noexcept {
  const double error = goal.angle - encoder_.angle();
  const double wanted = std::clamp(cascade_.speed_for(error, goal.speed) + goal.speed_add,
                                   -limits.speed, limits.speed);
  const bool there = std::abs(error) < 1.5 * encoder_.increment();
  return cascade_.torque_for(wanted - encoder_.speed(), goal.torque, available(limits),
                             there && goal.speed == 0 && encoder_.speed() == 0);
}

/// Returns the torques that the motor can give. Near its greatest speed, no voltage is left to
/// accelerate it.
TorqueRange Servo::available(const ServoLimits& limits) const noexcept {
  const double speed = encoder_.speed();
  const double left = fastest_ - std::abs(speed);
  const double full = 0.1 * fastest_;
  TorqueRange range = limits.torque;
  if (left < full) (speed > 0 ? range.positive : range.negative) *= std::max(left / full, 0.0);
  return range;
}

}  // namespace takt::sim
