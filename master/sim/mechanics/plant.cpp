#include "master/sim/mechanics/plant.hpp"

#include <algorithm>
#include <cmath>

namespace takt::sim {
namespace {

/// Returns the inertia of the parts that are rigidly connected to the shaft of the motor.
double own_inertia(const MechanicsTable& table) noexcept {
  return table.motor.inertia + (table.load.stiffness ? 0 : table.load.inertia);
}

double own_friction(const MechanicsTable& table) noexcept {
  return table.motor.friction + (table.load.stiffness ? 0 : table.load.friction);
}

/// Returns the damping of the coupling. The faces of a coupling with backlash meet within a step,
/// and this adds energy to an undamped spring. With backlash, the spring therefore acts with the
/// twist after the step, which removes more energy than the contact adds.
double contact_damping(const MechanicsTable& table, double span) noexcept {
  if (table.load.backlash == 0) return table.load.damping;
  return table.load.damping + table.load.stiffness.value_or(0) * span;
}

}  // namespace

Plant::Plant(const MechanicsTable& table) noexcept
    : is_rigid_{!table.load.stiffness},
      steps_{mechanics_steps(table)},
      span_{mechanics_tick / steps_},
      inertia_{table.motor.inertia + table.load.inertia},
      stiffness_{table.load.stiffness.value_or(0)},
      damping_{contact_damping(table, span_)},
      half_gap_{table.load.backlash / 2},
      weight_{table.load.torque},
      motor_mobility_{span_ / own_inertia(table)},
      load_mobility_{span_ / table.load.inertia},
      touching_{coupled(table, damping_)},
      apart_{coupled(table, 0)},
      motor_friction_{own_friction(table), table.motor.breakaway, span_, own_inertia(table)},
      load_friction_{table.load.friction, table.load.breakaway, span_, table.load.inertia} {}

/// Inverts the equations of the two speeds after a step: viscous friction acts on each, the damper
/// on their difference.
Plant::Coupled Plant::coupled(const MechanicsTable& table, double damping) const noexcept {
  const double both = table.motor.viscosity + table.load.viscosity;
  if (is_rigid_) return {.own_motor = 1 / (1 + motor_mobility_ * both)};
  const double motor = 1 + motor_mobility_ * (table.motor.viscosity + damping);
  const double load = 1 + load_mobility_ * (table.load.viscosity + damping);
  const double to_motor = motor_mobility_ * damping;
  const double to_load = load_mobility_ * damping;
  const double determinant = motor * load - to_motor * to_load;
  return {.own_motor = load / determinant,
          .own_load = motor / determinant,
          .other_motor = to_motor / determinant,
          .other_load = to_load / determinant};
}

void Plant::advance(double torque, double brake) noexcept {
  if (is_rigid_) return advance_rigid(torque, brake);
  for (int i = 0; i < steps_; ++i) advance_elastic(torque, brake);
}

void Plant::advance_rigid(double torque, double brake) noexcept {
  const double driven = motor_.speed + motor_mobility_ * (torque + weight_);
  motor_.speed = bounded(motor_friction_.slow(motor_.speed, driven * touching_.own_motor, brake));
  motor_.angle += span_ * motor_.speed;
  stop_at_ends(motor_);
}

/// Returns the twist of the spring. It is 0 inside the backlash.
double Plant::wound() const noexcept {
  const double twist = motor_.angle - load_.angle;
  return twist - std::clamp(twist, -half_gap_, half_gap_);
}

void Plant::advance_elastic(double torque, double brake) noexcept {
  const double spring = stiffness_ * wound();
  const double motor = motor_.speed + motor_mobility_ * (torque - spring);
  const double load = load_.speed + load_mobility_ * (spring + weight_);
  double motor_speed = touching_.own_motor * motor + touching_.other_motor * load;
  double load_speed = touching_.own_load * load + touching_.other_load * motor;
  // Two faces push, but never pull. If they would have to pull, neither spring nor damper acts.
  const double push = spring + damping_ * (motor_speed - load_speed);
  if (half_gap_ > 0 && push * spring <= 0) {
    motor_speed = apart_.own_motor * (motor_.speed + motor_mobility_ * torque);
    load_speed = apart_.own_load * (load_.speed + load_mobility_ * weight_);
  }
  motor_.speed = bounded(motor_friction_.slow(motor_.speed, motor_speed, brake));
  load_.speed = bounded(load_friction_.slow(load_.speed, load_speed));
  motor_.angle += span_ * motor_.speed;
  load_.angle += span_ * load_.speed;
  stop_at_ends(load_);
}

/// Limits the speed, because an axis that falls without end would otherwise leave the range of
/// numbers.
double Plant::bounded(double speed) noexcept { return std::clamp(speed, -fastest, fastest); }

void Plant::stop_at_ends(Mass& mass) const noexcept {
  if (mass.angle >= low_stop_ && mass.angle <= high_stop_) return;
  mass.angle = std::clamp(mass.angle, low_stop_, high_stop_);
  mass.speed = 0;
}

}  // namespace takt::sim
