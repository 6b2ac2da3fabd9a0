#pragma once
#include <Eigen/Core>

#include "apps/move/pace.hpp"
#include "apps/move/taken_set_points.hpp"

namespace takt {

/// The way along one trajectory: holds slow it down, and it never runs far ahead of the set-points
/// that the bus has taken. All times in seconds.
class PacedMotion {
 public:
  /// `begin`: set-points of time 0 as an image shows them. `ramp`: as of Pace. `lead`: how far
  /// ahead of the bus, above zero.
  PacedMotion(const Eigen::VectorXd& begin, double ramp, double lead)
      : pace_{ramp}, taken_{begin}, lead_{lead} {}

  /// What the newest image shows as sent.
  void seen(const Eigen::VectorXd& shown) { taken_.seen(shown); }
  /// Advances by a step of real time; returns the time along the trajectory.
  double step(double seconds, Hold hold) noexcept;
  /// The set-points of this time are on their way; as an image will show them.
  void sent(const Eigen::VectorXd& shown) { taken_.sent(pace_.time(), shown); }

  double time() const noexcept { return pace_.time(); }
  bool standing() const noexcept { return pace_.standing(); }
  /// For so long it stands although nothing holds it: the bus takes no set-point.
  double refused() const noexcept { return refused_; }

 private:
  Pace pace_;
  TakenSetPoints taken_;
  double lead_;
  double refused_ = 0.0;
};

}  // namespace takt
