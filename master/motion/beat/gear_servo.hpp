#pragma once
#include "master/motion/limits.hpp"
#include "master/motion/profile.hpp"

namespace takt::motion {

/// Computes the next step of an axis that catches up with a moving target. In each step the jerk is
/// constant and inside its limit, so velocity, acceleration and jerk keep their limits between the
/// steps as well. If the axis begins outside a limit, it returns inside as fast as the other limits
/// permit.
///
/// A step towards a position assumes that the acceleration of the target falls to 0 with a jerk of
/// `jerk_for_settling` times the limit, and that the target then keeps its velocity. The step is
/// chosen so that the distance between axis and target becomes 0, without a change of its sign,
/// when the axis reaches this velocity. So the axis approaches in almost the shortest time and does
/// not overshoot a target of constant velocity. As soon as three steps within the limits lead
/// exactly to the target, the axis takes them. From then on, it follows a target that moves within
/// the limits without error.
///
/// Each step computes this distance at most `most_trials` + 2 times.
class GearServo {
 public:
  /// The fractions of the limits with which a catch-up is planned. The rest covers the difference
  /// between steps and a continuous motion.
  static constexpr double jerk_for_settling = 0.9;
  static constexpr double acceleration_for_settling = 0.95;
  static constexpr int most_trials = 8;

  GearServo() noexcept = default;
  explicit GearServo(const Limits& limits) noexcept : limits_{limits} {}

  /// Returns the state `period` seconds after `from`, at the time of `target`, on the way to the
  /// position, velocity and acceleration of the target. `target_jerk` is the jerk of the target.
  State step_to_position(const State& from, const State& target, double target_jerk,
                         double period) const noexcept;
  /// Returns the next state as step_to_position() does, but on the way to the velocity and
  /// acceleration of the target alone.
  State step_to_velocity(const State& from, const State& target, double period) const noexcept;
  /// Returns the next state as step_to_position() does, but on the way to the acceleration 0 at the
  /// velocity that results.
  State step_to_cruise(const State& from, double period) const noexcept;

 private:
  /// The accelerations that the axis may have after the next step.
  struct Room {
    double min = 0.0;
    double max = 0.0;
  };
  Room room_after(const State& from, double period) const noexcept;
  double distance_to_settle(double velocity, double acceleration) const noexcept;
  bool is_led(const State& from, const State& before, double target_jerk,
              double period) const noexcept;
  double catching_up(const State& from, const State& target, const Room& room,
                     double period) const noexcept;

  Limits limits_;
};

}  // namespace takt::motion
