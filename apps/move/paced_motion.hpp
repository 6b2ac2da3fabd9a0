#pragma once
#include <Eigen/Core>

#include "apps/move/pace.hpp"
#include "apps/move/taken_set_points.hpp"

namespace takt {

/// Motion along one trajectory. A hold slows it down, and it never runs far ahead of the set-points
/// that the bus has taken. All times are in seconds.
class PacedMotion {
 public:
  /// `begin` holds the set-points of time 0 as an image shows them. `ramp` is that of Pace. `lead`
  /// is how far the motion may run ahead of the bus, above zero.
  PacedMotion(const Eigen::VectorXd& begin, double ramp, double lead)
      : pace_{ramp}, taken_{begin}, lead_{lead} {}

  /// Takes the set-points that the newest image shows as sent.
  void seen(const Eigen::VectorXd& shown) { taken_.seen(shown); }
  /// Advances by a step of real time. Returns the time along the trajectory.
  double step(double seconds, Hold hold) noexcept;
  /// Records that the set-points of the present time were sent. `shown` holds them as an image will
  /// show them.
  void sent(const Eigen::VectorXd& shown) { taken_.sent(pace_.time(), shown); }

  double time() const noexcept { return pace_.time(); }
  bool standing() const noexcept { return pace_.standing(); }
  /// Returns for how long the motion has not advanced although nothing holds it, because the bus
  /// takes no set-point.
  double refused() const noexcept { return refused_; }
  /// Returns how far the set-points that the newest image shows are from the nearest ones of this
  /// motion, for each axis.
  const Eigen::VectorXd& apart() const noexcept { return taken_.apart(); }

 private:
  Pace pace_;
  TakenSetPoints taken_;
  double lead_;
  double refused_ = 0.0;
};

}  // namespace takt
