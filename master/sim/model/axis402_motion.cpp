#include <algorithm>
#include <cmath>
#include <utility>

#include "master/sim/model/axis402.hpp"

namespace takt::sim {
namespace {

constexpr Time longest_step = std::chrono::milliseconds{2};
constexpr Time longest_servo_step = std::chrono::milliseconds{1};
constexpr Time::rep most_steps = 2000;
constexpr std::uint16_t following_error_code = 0x8611;
constexpr std::uint16_t halt_bit = 0x100;
constexpr double default_ramp = 1e6;
constexpr double fastest = 2e9;
constexpr double unlimited = 1e15;
constexpr double friction = 0.02;  // times the rated torque

constexpr Time::rep steps_in(Time span, Time step) noexcept {
  return std::clamp<Time::rep>((span.count() + step.count() - 1) / step.count(), 1, most_steps);
}

std::int64_t rounded(double value) noexcept {
  return static_cast<std::int64_t>(value + std::copysign(0.5, value));
}

}  // namespace

void Axis402::advance(Time now) noexcept {
  const Time span = now - time_;
  if (span <= Time{}) return;
  if (idle()) {
    time_ = now;
    return;
  }
  const Time::rep steps =
      servo_ ? steps_in(span, longest_servo_step) : steps_in(span, longest_step);
  const Time from = time_;
  for (Time::rep i = 1; i <= steps; ++i) {
    const Time end = i == steps ? now : from + span * i / steps;
    const Time part = end - std::exchange(time_, end);
    step(part);
  }
  publish();
}

void Axis402::step(Time span) noexcept {
  const double h = static_cast<double>(span.count()) * 1e-9;
  if (state_ == DriveState::not_ready) {
    if (time_ < initialised_at_) return;
    enter(DriveState::switch_on_disabled);
  }
  if (!settled_) {
    follow_mode();
    follow_controlword();
  }
  if (!is_powered(state_)) {
    step_unpowered(h);
    demand_ = {motor_.position, 0};
    return;
  }
  if (state_ == DriveState::operation_enabled && stopping_to_ == state_) {
    step_enabled(h);
  } else {
    step_stopping(h);
  }
  supervise_following_error(span);
  supervise_target(span);
}

void Axis402::step_enabled(double h) noexcept {
  if (halted()) {
    ramp_velocity(demand_, 0, {.acceleration = 0, .deceleration = stop_deceleration()}, h);
    const bool by_velocity = servo_ && mode_ == DriveMode::profile_velocity;
    return by_velocity ? follow_velocity(demand_.velocity, unlimited, h) : follow_position(h);
  }
  if (!servo_ || !blocks(h)) step_mode(h);
}

bool Axis402::halted() const noexcept {
  if ((controlword_ & halt_bit) == 0) return false;
  return mode_ == DriveMode::profile_position || mode_ == DriveMode::profile_velocity ||
         mode_ == DriveMode::homing;
}

void Axis402::step_mode(double h) noexcept {
  switch (mode_) {
    case DriveMode::profile_position:
      profile_.step(demand_, ramps(), h);
      break;
    case DriveMode::homing:
      if (homing_.step(demand_, stop_deceleration(), h)) {
        const double shift = homing_.shift();
        demand_.position += shift;
        motor_.position += shift;
        if (servo_) servo_->shift(shift);
      }
      break;
    case DriveMode::cyclic_position:
    case DriveMode::interpolated_position:
      if (servo_ && mode_ == DriveMode::interpolated_position) {
        step_points(h);
        break;
      }
      cyclic_.step(demand_, h);
      break;
    case DriveMode::profile_velocity:
      ramp_velocity(demand_, static_cast<double>(objects_.target_velocity.get()), ramps(), h);
      return follow_velocity(demand_.velocity, strongest(), h);
    case DriveMode::cyclic_velocity: {
      const auto target = objects_.target_velocity.get() + objects_.velocity_offset.get();
      const double limit = objects_.max_acceleration.positive_or(servo_ ? unlimited : strongest());
      return follow_velocity(static_cast<double>(target), limit, h);
    }
    case DriveMode::profile_torque:
    case DriveMode::cyclic_torque:
      return step_torque(h);
    case DriveMode::none:
      break;
  }
  follow_position(h);
}

void Axis402::step_torque(double h) noexcept {
  const auto torque =
      static_cast<double>(objects_.target_torque.get() + objects_.torque_offset.get());
  if (servo_) {
    servo_->follow_torque(torque / 1000, mode_ == DriveMode::profile_torque, time_);
    read_servo();
    demand_ = {motor_.position, motor_.velocity};
    return;
  }
  const double drag = friction * rated_acceleration_ * std::tanh(motor_.velocity / 100);
  const double speed = motor_.velocity + (torque / 1000 * rated_acceleration_ - drag) * h;
  motor_.follow_velocity(std::clamp(speed, -fastest, fastest), strongest(), h);
  demand_ = {motor_.position, motor_.velocity};
}

void Axis402::step_stopping(double h) noexcept {
  const double deceleration = stop_deceleration();
  ramp_velocity(demand_, 0, {.acceleration = deceleration, .deceleration = deceleration}, h);
  follow_position(h);
  if (demand_.velocity != 0 || !stands()) return;
  motor_.velocity = 0;
  stop_has_ended();
}

void Axis402::stop_has_ended() noexcept {
  const std::int64_t option = objects_.quick_stop_option.get();
  if (state_ == DriveState::fault_reaction) {
    enter(DriveState::fault);
  } else if (state_ == DriveState::operation_enabled) {
    enter(stopping_to_);
  } else if (option < 5 || option > 8) {
    enter(DriveState::switch_on_disabled);
  }
}

double Axis402::stop_deceleration() const noexcept {
  const double slow = objects_.profile_deceleration.positive_or(
      objects_.profile_acceleration.positive_or(default_ramp));
  const double quick = objects_.quick_stop_deceleration.positive_or(4 * slow);
  std::int64_t option = objects_.halt_option.get();
  if (state_ == DriveState::quick_stop) option = (objects_.quick_stop_option.get() - 1) % 4 + 1;
  if (state_ == DriveState::fault_reaction) option = objects_.fault_option.get();
  if (stopping_to_ != DriveState::operation_enabled) option = 1;
  if (option <= 1) return slow;
  return option == 2 ? quick : strongest();
}

Ramps Axis402::ramps() const noexcept {
  const double up = objects_.profile_acceleration.positive_or(default_ramp);
  const double speed = static_cast<double>(objects_.profile_velocity.get());
  return {.velocity = std::min(speed, objects_.max_profile_velocity.positive_or(fastest)),
          .acceleration = up,
          .deceleration = objects_.profile_deceleration.positive_or(up)};
}

bool Axis402::controls_position() const noexcept {
  return mode_ == DriveMode::profile_position || mode_ == DriveMode::cyclic_position ||
         mode_ == DriveMode::interpolated_position || mode_ == DriveMode::homing;
}

/// Supervises the following error with the window 0x6065 and the timeout 0x6066. A window of 0 or
/// 0xFFFFFFFF disables the supervision.
void Axis402::supervise_following_error(Time span) noexcept {
  const std::int64_t window = objects_.following_window.get();
  const double error = std::abs(demand_.position - motor_.position);
  const bool watched = window != 0 && window != 0xFFFF'FFFF && controls_position();
  if (!watched || error <= static_cast<double>(window)) {
    following_time_ = Time{};
    following_error_ = false;
    return;
  }
  following_time_ += span;
  if (following_time_ < std::chrono::milliseconds{objects_.following_timeout.get()}) return;
  fail(following_error_code);
  following_error_ = true;
}

void Axis402::supervise_target(Time span) noexcept {
  bool there = false;
  if (halted()) {
    there = stands();
  } else if (mode_ == DriveMode::profile_position) {
    const double off = std::abs(demand_.position - motor_.position);
    there = profile_.arrived() && off <= static_cast<double>(objects_.position_window.get()) + 0.5;
  } else if (mode_ == DriveMode::profile_velocity) {
    const auto target = static_cast<double>(objects_.target_velocity.get());
    there =
        std::abs(motor_.velocity - target) <= static_cast<double>(objects_.velocity_window.get());
  }
  target_time_ = there ? target_time_ + span : Time{};
  on_target_ = there && target_time_ >= std::chrono::milliseconds{objects_.position_time.get()};
}

std::uint16_t Axis402::mode_bits() const noexcept {
  if (state_ != DriveState::operation_enabled) return 0;
  const bool new_target = mode_ == DriveMode::profile_position && !profile_.arrived() && !halted();
  const unsigned reached = on_target_ && !new_target ? 0x0400 : 0;
  switch (mode_) {
    case DriveMode::profile_position:
      return static_cast<std::uint16_t>(reached | (profile_.acknowledges() ? 0x1000u : 0u));
    case DriveMode::profile_velocity: {
      const auto threshold = static_cast<double>(objects_.velocity_threshold.get());
      const bool stands = std::abs(motor_.velocity) <= threshold;
      return static_cast<std::uint16_t>(reached | (stands ? 0x1000u : 0u));
    }
    case DriveMode::homing:
      return homing_.status_bits(demand_.velocity == 0);
    case DriveMode::interpolated_position:
      return (servo_ ? interpolates_ : (controlword_ & 0x10) != 0) ? 0x1000 : 0;
    case DriveMode::cyclic_position:
    case DriveMode::cyclic_velocity:
    case DriveMode::cyclic_torque:
      return blocked_ ? 0 : 0x1000;  // drive follows the command value
    case DriveMode::profile_torque:
      return 0x0400;
    case DriveMode::none:
      return 0;
  }
  return 0;
}

std::uint16_t Axis402::statusword() const noexcept {
  constexpr unsigned voltage = 0x10;
  constexpr unsigned remote = 0x200;
  unsigned word = state_bits(state_) | mode_bits();
  if (state_ == DriveState::not_ready) return static_cast<std::uint16_t>(word);
  word |= voltage | remote;
  const bool limited = mode_ == DriveMode::profile_position
                           ? profile_.limited()
                           : mode_ == DriveMode::cyclic_position && cyclic_.limited();
  if (limited && state_ == DriveState::operation_enabled) word |= 0x0800;
  if (servo_ && (blocked_ || servo_->servo().limited())) word |= 0x0800;
  if (following_error_) word |= 0x2000;
  return static_cast<std::uint16_t>(word);
}

void Axis402::publish() noexcept {
  publish_state();
  publish_motion();
}

void Axis402::publish_state() noexcept {
  objects_.statusword.set(statusword());
  objects_.mode_display.set(static_cast<std::int64_t>(mode_));
}

void Axis402::publish_motion() noexcept {
  published_ = time_;
  const std::uint32_t inputs = servo_ ? servo_->sensors().inputs() : 0;
  objects_.digital_inputs.set(inputs | (homing_.on_switch() ? 4U : 0U));
  if (servo_) return servo_->publish(demand_, is_powered(state_), time_);
  const std::int64_t actual = rounded(motor_.position);
  const std::int64_t wanted = rounded(demand_.position);
  objects_.position_actual.set(actual);
  objects_.position_actual_internal.set(actual);
  objects_.position_demand.set(wanted);
  objects_.position_demand_internal.set(wanted);
  objects_.following_error.set(wanted - actual);
  objects_.velocity_actual.set(rounded(motor_.velocity));
  objects_.velocity_demand.set(rounded(demand_.velocity));
  publish_torque();
}

void Axis402::publish_torque() noexcept {
  if (!is_powered(state_)) {
    objects_.torque_actual.set(0);
    objects_.torque_demand.set(0);
    objects_.current_actual.set(0);
    return;
  }
  const double drag = friction * std::clamp(motor_.velocity / 100, -1.0, 1.0);
  const double torque = 1000 * (motor_.acceleration / rated_acceleration_ + drag);
  const std::int64_t reported = rounded(std::clamp(torque, -32767.0, 32767.0));
  objects_.torque_actual.set(reported);
  objects_.torque_demand.set(reported);
  objects_.current_actual.set(reported);
}

}  // namespace takt::sim
