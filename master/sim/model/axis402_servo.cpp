#include <algorithm>
#include <cmath>

#include "master/sim/model/axis402.hpp"

// The motor of an axis: a servo with its mechanics, or a simple lag.

namespace takt::sim {
namespace {

// Largest acceleration of the simple motor, as a multiple of that at the rated torque.
constexpr double peak = 10;

}  // namespace

/// Returns the largest acceleration of the axis, in counts/s2.
double Axis402::strongest() const noexcept {
  return servo_ ? servo_->strongest() : peak * rated_acceleration_;
}

bool Axis402::stands() const noexcept {
  return servo_ ? servo_->servo().stands() : std::abs(motor_.velocity) < 1;
}

void Axis402::read_servo() noexcept {
  motor_.position = servo_->servo().position();
  motor_.velocity = servo_->servo().velocity();
}

void Axis402::step_unpowered(double h) noexcept {
  if (!servo_) return motor_.coast(rated_acceleration_ / 4, h);
  releases_ ? servo_->hold(time_) : servo_->rest(time_);
  read_servo();
}

void Axis402::follow_position(double h) noexcept {
  if (!servo_) return motor_.follow_position(demand_, peak * rated_acceleration_, h);
  servo_->follow_position(demand_, mode_ == DriveMode::cyclic_position, time_);
  read_servo();
}

/// Follows a velocity; `limit` is the largest acceleration.
void Axis402::follow_velocity(double target, double limit, double h) noexcept {
  if (!servo_) {
    demand_.velocity = target;
    motor_.follow_velocity(target, limit, h);
  } else {
    const double old = demand_.velocity;
    demand_.velocity = std::clamp(target, old - limit * h, old + limit * h);
    servo_->follow_velocity(demand_.velocity, mode_ == DriveMode::cyclic_velocity, time_);
    read_servo();
  }
  demand_.position = motor_.position;
}

/// Returns the direction (1 or -1) in which the set-points of the present mode move the axis; 0 if
/// they do not move it.
double Axis402::wanted_direction() const noexcept {
  const auto sign = [](double value) { return value > 0 ? 1.0 : value < 0 ? -1.0 : 0.0; };
  switch (mode_) {
    case DriveMode::profile_position:
      return sign(profile_.target() - demand_.position);
    case DriveMode::interpolated_position:
    case DriveMode::cyclic_position:
      return sign(cyclic_.slope());
    case DriveMode::profile_velocity:
      return sign(static_cast<double>(objects_.target_velocity.get()));
    case DriveMode::cyclic_velocity:
      return sign(
          static_cast<double>(objects_.target_velocity.get() + objects_.velocity_offset.get()));
    case DriveMode::profile_torque:
    case DriveMode::cyclic_torque:
      return sign(static_cast<double>(objects_.target_torque.get() + objects_.torque_offset.get()));
    case DriveMode::homing:
    case DriveMode::none:
      return 0;
  }
  return 0;
}

/// Returns the deceleration of a stop that the drive itself begins, in counts/s2.
double Axis402::stop_ramp() const noexcept {
  const double slow = objects_.profile_deceleration.positive_or(strongest());
  return objects_.quick_stop_deceleration.positive_or(slow);
}

/// Stops the axis on the quick-stop ramp while it is at the end of its travel and its set-points
/// would move it beyond this end. The axis stays enabled. Returns false if the axis can follow its
/// set-points.
bool Axis402::blocks(double h) noexcept {
  const bool was_blocked = blocked_;
  blocked_ = servo_->at_end(wanted_direction());
  if (!blocked_) return false;
  if (!was_blocked && !controls_position()) meet_motion();
  ramp_velocity(demand_, 0, {.deceleration = stop_ramp()}, h);
  follow_position(h);
  return true;
}

/// Takes the next point of the buffer. Returns false if it is empty.
bool Axis402::next_point() noexcept {
  const auto point = points_.take();
  if (!point) return false;
  cyclic_.take(demand_, *point, reported_period(), objects_.max_profile_velocity.positive_or(1e12));
  return true;
}

/// Mode interpolated position: one point of the buffer in each period 0x60C2. If the buffer is
/// empty when the next point is due, the axis stops on the quick-stop ramp, and the mode is
/// inactive until bit 4 of the controlword rises again.
void Axis402::step_points(double h) noexcept {
  constexpr double resolution = 1e-9;
  while (interpolates_ && h > resolution) {
    if (cyclic_.left() == 0 && !next_point()) {
      interpolates_ = demand_.velocity == 0;  // before the first point, the axis waits
      break;
    }
    const double part = std::min(h, cyclic_.left());
    cyclic_.step(demand_, part);
    h -= part;
  }
  if (interpolates_) return;
  cyclic_.start(demand_);
  ramp_velocity(demand_, 0, {.deceleration = stop_ramp()}, h);
}

}  // namespace takt::sim
