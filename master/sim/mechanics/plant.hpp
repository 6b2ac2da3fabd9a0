#pragma once
#include <limits>

#include "eds_parser/table/mechanics.hpp"
#include "master/sim/mechanics/friction.hpp"

namespace takt::sim {

/// One mass, referred to the shaft of the motor.
struct Mass {
  double angle = 0;  ///< rad
  double speed = 0;  ///< rad/s
};

/// Motor and load of an axis. Either they are one mass, or a spring with a damper couples them,
/// with backlash if there is any. Both have dry and viscous friction; the load may have a constant
/// torque and hard stops. The step is fixed, and the result depends on the torques alone.
///
/// The integration is semi-implicit: damping and viscous friction act with the speeds after the
/// step, the spring with the twist before it (with backlash: after it), and positions move with the
/// new speeds. The integration is stable as long as a step turns the stiffest mode by less than 2
/// rad. mechanics_steps() chooses steps of at most 0.5 rad.
class Plant {
 public:
  explicit Plant(const MechanicsTable& table) noexcept;

  /// Advances by mechanics_tick with a constant `torque` (N m) of the motor. `brake` is the torque
  /// that a brake on the shaft of the motor can hold.
  void advance(double torque, double brake) noexcept;
  /// Sets hard stops: the load can't leave the range from `low` to `high` (rad).
  void set_stops(double low, double high) noexcept {
    low_stop_ = low;
    high_stop_ = high;
  }

  const Mass& motor() const noexcept { return motor_; }
  const Mass& load() const noexcept { return is_rigid_ ? motor_ : load_; }
  bool stands() const noexcept { return motor_.speed == 0 && load_.speed == 0; }
  /// Returns the inertia of motor and load together.
  double inertia() const noexcept { return inertia_; }

 private:
  /// The speed of a mass after a step is `own` times the speed that the torques alone would give
  /// it, plus `other` times the speed that they would give the other mass.
  struct Coupled {
    double own_motor = 1;
    double own_load = 1;
    double other_motor = 0;
    double other_load = 0;
  };

  Coupled coupled(const MechanicsTable& table, double damping) const noexcept;
  void advance_rigid(double torque, double brake) noexcept;
  void advance_elastic(double torque, double brake) noexcept;
  double wound() const noexcept;
  void stop_at_ends(Mass& mass) const noexcept;
  static double bounded(double speed) noexcept;

  static constexpr double fastest = 1e6;  // rad/s

  bool is_rigid_;
  int steps_;
  double span_;     ///< s, of one step
  double inertia_;  ///< kg m2
  double stiffness_;
  double damping_;
  double half_gap_;
  double weight_;          ///< N m
  double motor_mobility_;  ///< speed that a torque gives in one step
  double load_mobility_;
  Coupled touching_;
  Coupled apart_;
  Friction motor_friction_;
  Friction load_friction_;
  double low_stop_ = -std::numeric_limits<double>::infinity();
  double high_stop_ = std::numeric_limits<double>::infinity();
  Mass motor_;
  Mass load_;  ///< only if the coupling is elastic
};

}  // namespace takt::sim
