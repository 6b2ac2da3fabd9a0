#pragma once
#include <cstdint>

#include "eds_parser/table/mechanics.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/mechanics/brake.hpp"
#include "master/sim/mechanics/cascade.hpp"
#include "master/sim/mechanics/encoder.hpp"
#include "master/sim/mechanics/plant.hpp"

namespace takt::sim {

/// The quantity that the controllers of a servo control.
enum class ServoLoop : std::uint8_t {
  off,   ///< no torque; if the axis is at standstill, it is held until its brake has closed
  hold,  ///< the position at which this loop began
  torque,
  velocity,
  position,
};

/// A set-point, in counts of the axis.
struct ServoReference {
  ServoLoop loop = ServoLoop::off;
  double position = 0;
  double velocity = 0;      ///< counts/s; in the loop `position`, the velocity of the set-points
  double velocity_add = 0;  ///< counts/s, added after the position controller
  double torque = 0;        ///< N m, set-point, or addition after the velocity controller
};

/// The largest torques, in N m, and the largest speed of the motor, in rad/s. All are positive.
struct ServoLimits {
  TorqueRange torque{};
  double speed = 0;
};

/// A servo axis: controllers, current, motor, load, brake and encoder. It runs in ticks of
/// mechanics_tick from the time of reset() on; between two ticks nothing changes.
class Servo {
 public:
  explicit Servo(const MechanicsTable& table) noexcept;

  /// Begins a new run at this time. The position is kept, the motor is without torque.
  void reset(Time now) noexcept;
  /// Advances to `until`. Between the last reference and `next`, the set-points lie on a straight
  /// line if both belong to the same loop.
  void run(const ServoReference& next, const ServoLimits& limits, Time until) noexcept;
  /// Adds `counts` to all positions.
  void shift(double counts) noexcept;
  /// Sets hard stops: the load can't leave this range of positions.
  void set_stops(double low, double high) noexcept;

  /// Returns the position that the drive reports at this time, in counts: rounded to increments of
  /// the encoder, and as old as its dead time. `now` must not be before the last run().
  double reported(Time now) const noexcept;
  /// Returns the position at the angle 0 of the motor.
  double origin() const noexcept { return origin_; }
  /// Returns position and speed from the encoder, in counts and counts/s.
  double position() const noexcept { return counts(encoder_.angle()); }
  double velocity() const noexcept { return encoder_.speed() * counts_per_radian_; }
  /// Returns the position in increments of the encoder, which a shift() doesn't change.
  double increments() const noexcept { return encoder_.angle() / encoder_.increment(); }
  /// Returns the true positions of motor and load.
  double motor_position() const noexcept { return counts(plant_.motor().angle); }
  double load_position() const noexcept { return counts(plant_.load().angle); }
  double torque() const noexcept { return torque_; }         ///< N m
  double wanted_torque() const noexcept { return wanted_; }  ///< N m
  bool limited() const noexcept { return cascade_.limited(); }
  /// Returns true if the axis may move: it has no brake, or the brake is open.
  bool released() const noexcept { return !brake_.is_closed(); }
  /// Returns true if motor and load are at rest, and will not move while there is no torque.
  bool rests() const noexcept;
  /// Returns true if the axis turns by less than half a turn in a minute.
  bool stands() const noexcept { return std::abs(encoder_.speed()) < standstill; }
  /// Returns how far ahead of the position the set-point is at this velocity (counts).
  double lead(double velocity) const noexcept { return cascade_.error_at(velocity); }
  /// Returns the acceleration that this torque (N m) gives, in counts/s2.
  double acceleration(double torque) const noexcept {
    return torque / plant_.inertia() * counts_per_radian_;
  }

 private:
  static constexpr Time tick{250'000};
  static constexpr double standstill = 0.05;  // rad/s

  /// A reference in units of the motor: rad, rad/s, N m.
  struct Goal {
    ServoLoop loop = ServoLoop::position;
    double angle = 0;
    double speed = 0;
    double speed_add = 0;
    double torque = 0;
  };

  double counts(double angle) const noexcept { return angle * counts_per_radian_ + origin_; }
  double angle(double counts) const noexcept { return (counts - origin_) / counts_per_radian_; }
  void begin(ServoLoop loop) noexcept;
  void step(const Goal& goal, const ServoLimits& limits) noexcept;
  double torque_for(const Goal& goal, const ServoLimits& limits) noexcept;
  double torque_at(const Goal& goal, const ServoLimits& limits) noexcept;
  TorqueRange available(const ServoLimits& limits) const noexcept;

  Plant plant_;
  ShaftEncoder encoder_;
  Cascade cascade_;
  Brake brake_;
  double counts_per_radian_;
  double current_step_;  ///< part of a change of torque that takes effect in one tick
  double fastest_;       ///< rad/s, of the motor
  double origin_ = 0;    ///< position at angle 0, in counts
  double torque_ = 0;
  double wanted_ = 0;
  double held_ = 0;     ///< angle that is held, in rad
  bool holds_ = false;  ///< the loop `off` still holds the axis until its brake closes
  ServoReference last_{};
  Time time_{};
  Time run_until_{};
};

}  // namespace takt::sim
