#pragma once
#include <cstdint>

#include "eds_parser/table/mechanics.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/axis/axis_objects.hpp"
#include "master/sim/axis/motion.hpp"
#include "master/sim/axis/touch_probe.hpp"
#include "master/sim/mechanics/servo.hpp"
#include "master/sim/mechanics/travel_sensors.hpp"
#include "master/sim/random.hpp"

namespace takt::sim {

/// The mechanics behind one axis: connects a servo with the objects of the axis. Positions are in
/// counts, velocities in counts/s. All calls that move the axis advance it to `until`.
class AxisServo {
 public:
  /// `random` places the index pulse if the table does not.
  AxisServo(AxisObjects& objects, const MechanicsTable& table, Random random) noexcept;

  void reset(Time now) noexcept;
  /// Lets the axis rest without torque, or holds it until its brake has closed.
  void rest(Time until) noexcept { run({.loop = ServoLoop::off}, until); }
  /// Holds the position with torque, for example until the brake has opened.
  void hold(Time until) noexcept { run({.loop = ServoLoop::hold}, until); }
  /// Follows positions; the velocity and torque offsets (0x60B1, 0x60B2) act if `has_offsets`.
  void follow_position(const Demand& demand, bool has_offsets, Time until) noexcept;
  void follow_velocity(double velocity, bool has_offsets, Time until) noexcept;
  /// `torque` is a multiple of the rated torque. If `has_slope`, it changes with 0x6087 at most.
  void follow_torque(double torque, bool has_slope, Time until) noexcept;
  void shift(double counts) noexcept { servo_.shift(counts); }

  const Servo& servo() const noexcept { return servo_; }
  /// Returns the sensors, whose positions do not include origin().
  const TravelSensors& sensors() const noexcept { return sensors_; }
  double origin() const noexcept { return servo_.origin(); }
  /// Returns true if the axis is at the end of its travel in a direction (1 or -1): on the limit
  /// switch, or at the software limit 0x607D.
  bool at_end(double direction) const noexcept;
  /// Returns the set-point with which the position controller keeps the present motion.
  Demand demand() const noexcept;
  /// Returns the acceleration of the axis with its largest torque, in counts/s2.
  double strongest() const noexcept { return servo_.acceleration(table_.motor.peak_torque); }
  /// Writes position, velocity, following error and torque into the objects.
  void publish(const Demand& demand, bool powered, Time now) noexcept;

 private:
  void run(const ServoReference& reference, Time until) noexcept;
  ServoLimits limits() const noexcept;
  double torque_of(const Slot& slot) const noexcept;
  double limit_of(const Slot& slot) const noexcept;

  AxisObjects& objects_;
  MechanicsTable table_;
  Servo servo_;
  TravelSensors sensors_;
  TouchProbe probe_;
  double torque_ = 0;  ///< present set-point of the torque modes, times the rated torque
  Time time_{};
};

}  // namespace takt::sim
