#include "master/sim/axis/axis_servo.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace takt::sim {
namespace {

constexpr double rpm = 2 * std::numbers::pi / 60;  // rad/s

std::int64_t whole(double value) noexcept {
  return static_cast<std::int64_t>(nearest(std::clamp(value, -2e9, 2e9)));
}

}  // namespace

AxisServo::AxisServo(AxisObjects& objects, const MechanicsTable& table, Random random) noexcept
    : objects_{objects},
      table_{table},
      servo_{table},
      sensors_{table.travel, table.turn, table.turn * random.below(1'000'000) / 1e6},
      probe_{objects} {
  if (table.travel.stops) servo_.set_stops(table.travel.stops->low, table.travel.stops->high);
}

void AxisServo::reset(Time now) noexcept {
  servo_.reset(now);
  probe_.reset();
  torque_ = 0;
  time_ = now;
}

void AxisServo::run(const ServoReference& reference, Time until) noexcept {
  if (reference.loop != ServoLoop::torque) torque_ = servo_.torque() / table_.motor.rated_torque;
  servo_.run(reference, limits(), until);
  sensors_.look(servo_.motor_position() - origin(), servo_.load_position() - origin());
  probe_.look(sensors_, origin());
  time_ = until;
}

bool AxisServo::at_end(double direction) const noexcept {
  const bool forward = direction > 0;
  if (direction == 0) return false;
  if (sensors_.active(forward ? TravelSwitch::positive_limit : TravelSwitch::negative_limit)) {
    return true;
  }
  const auto low = static_cast<double>(objects_.limit_min.get());
  const auto high = static_cast<double>(objects_.limit_max.get());
  if (low >= high) return false;
  return forward ? servo_.position() >= high : servo_.position() <= low;
}

void AxisServo::follow_position(const Demand& demand, bool has_offsets, Time until) noexcept {
  const auto added = static_cast<double>(objects_.velocity_offset.get());
  run({.loop = ServoLoop::position,
       .position = demand.position,
       .velocity = demand.velocity,
       .velocity_add = has_offsets ? added : 0,
       .torque = has_offsets ? torque_of(objects_.torque_offset) : 0},
      until);
}

void AxisServo::follow_velocity(double velocity, bool has_offsets, Time until) noexcept {
  run({.loop = ServoLoop::velocity,
       .velocity = velocity,
       .torque = has_offsets ? torque_of(objects_.torque_offset) : 0},
      until);
}

void AxisServo::follow_torque(double torque, bool has_slope, Time until) noexcept {
  const double span = static_cast<double>((until - time_).count()) * 1e-9;
  const double slope = objects_.torque_slope.positive_or(0) / 1000;
  const double most = has_slope && slope > 0 ? slope * span : 1e6;
  torque_ = std::clamp(torque, torque_ - most, torque_ + most);
  run({.loop = ServoLoop::torque, .torque = torque_ * table_.motor.rated_torque}, until);
}

/// Returns the torque (N m) in an object in 0.1 % of the rated torque.
double AxisServo::torque_of(const Slot& slot) const noexcept {
  return static_cast<double>(slot.get()) / 1000 * table_.motor.rated_torque;
}

/// Returns a limit in N m. A drive without this object has the limit of its motor alone.
double AxisServo::limit_of(const Slot& slot) const noexcept {
  const double peak = table_.motor.peak_torque;
  return slot.exists() ? std::min(peak, torque_of(slot)) : peak;
}

ServoLimits AxisServo::limits() const noexcept {
  const double both = std::min(limit_of(objects_.max_torque), limit_of(objects_.max_current));
  return {
      .torque = {.positive = std::min(both, limit_of(objects_.positive_torque_limit)),
                 .negative = std::min(both, limit_of(objects_.negative_torque_limit))},
      .speed = std::min(table_.motor.max_speed, objects_.max_motor_speed.positive_or(1e9) * rpm)};
}

Demand AxisServo::demand() const noexcept {
  const double velocity = servo_.velocity();
  return {servo_.position() + servo_.lead(velocity), velocity};
}

void AxisServo::publish(const Demand& demand, bool powered, Time now) noexcept {
  const std::int64_t actual = whole(servo_.reported(now));
  const std::int64_t wanted = whole(demand.position);
  objects_.position_actual.set(actual);
  objects_.position_actual_internal.set(whole(servo_.increments()));
  objects_.position_demand.set(wanted);
  objects_.position_demand_internal.set(wanted);
  objects_.following_error.set(powered ? wanted - actual : 0);
  objects_.velocity_actual.set(whole(servo_.velocity()));
  objects_.velocity_demand.set(whole(demand.velocity));
  const double rated = table_.motor.rated_torque;
  const std::int64_t torque = whole(1000 * servo_.torque() / rated);
  objects_.torque_demand.set(whole(1000 * servo_.wanted_torque() / rated));
  objects_.torque_actual.set(torque);
  objects_.current_actual.set(torque);
}

}  // namespace takt::sim
