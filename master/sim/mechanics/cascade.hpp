#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "eds_parser/table/mechanics.hpp"

namespace takt::sim {

/// The largest torque (N m) in each direction; both are positive.
struct TorqueRange {
  double positive = 0;
  double negative = 0;

  double clamp(double torque) const noexcept { return std::clamp(torque, -negative, positive); }
};

/// The controllers of a servo drive: position (P, with feed-forward of the velocity of the
/// set-points), velocity (PI), and torque. The integral does not grow while a limit acts.
class Cascade {
 public:
  Cascade(const MechanicsTable& table, double inertia) noexcept
      : position_gain_{table.controller.position_gain},
        feed_forward_{table.controller.velocity_feed_forward},
        gain_{2 * std::numbers::pi * table.controller.velocity_bandwidth * inertia},
        integral_gain_{gain_ * mechanics_tick / table.controller.integral_time} {}

  void reset() noexcept { integral_ = 0; }
  /// Returns the speed (rad/s) that the position controller demands. `error` is the following error
  /// in rad, `speed` that of the set-points.
  double speed_for(double error, double speed) const noexcept {
    return position_gain_ * error + feed_forward_ * speed;
  }
  /// Returns the following error at which speed_for() demands the speed `speed` while the
  /// set-points have the same speed.
  double error_at(double speed) const noexcept {
    return speed * (1 - feed_forward_) / position_gain_;
  }
  /// Returns the torque (N m) for an error of the speed. While the axis is `at_rest` on its target,
  /// the integral keeps its value. Otherwise friction and the integral would let the axis oscillate
  /// around its target.
  double torque_for(double speed_error, double offset, const TorqueRange& range,
                    bool at_rest) noexcept {
    const double wanted = gain_ * speed_error + integral_ + offset;
    const double torque = range.clamp(wanted);
    const bool winds_up = torque != wanted && (wanted - torque) * speed_error > 0;
    if (!at_rest && !winds_up) integral_ = range.clamp(integral_ + integral_gain_ * speed_error);
    limited_ = torque != wanted;
    return torque;
  }
  bool limited() const noexcept { return limited_; }
  void set_limited(bool limited) noexcept { limited_ = limited; }

 private:
  double position_gain_;
  double feed_forward_;
  double gain_;           ///< N m per rad/s
  double integral_gain_;  ///< N m per rad/s in each tick
  double integral_ = 0;   ///< N m
  bool limited_ = false;  ///< the last torque was cut by a limit
};

}  // namespace takt::sim
