#pragma once
#include <Eigen/Core>
#include <limits>

#include "apps/move/set_points/taken_set_points.hpp"

namespace takt {

enum class Hold : unsigned char { no, yes };

/// Time along a trajectory. It does not advance while the motion is held. Its rate changes between
/// 0 and 1 in a ramp, so that the motion stops and continues smoothly on the same path.
class Pace {
 public:
  /// `ramp` is the duration from full speed to standstill in seconds, above zero.
  explicit Pace(double ramp) noexcept : ramp_{ramp} {}

  /// Advances by a step of real time in seconds, above zero. Returns the time along the trajectory
  /// in seconds. At the time `latest` the trajectory stops at once; from there it continues in a
  /// ramp.
  double step(double seconds, Hold hold,
              double latest = std::numeric_limits<double>::infinity()) noexcept;
  double time() const noexcept { return time_; }
  double rate() const noexcept { return rate_; }
  bool standing() const noexcept { return rate_ == 0.0; }

 private:
  double ramp_;
  double time_ = 0.0;
  double rate_ = 1.0;
};

/// Motion along one trajectory. A hold slows the motion down to standstill. The motion never runs
/// far ahead of the set-points that the bus has taken. All times are in seconds.
class PacedMotion {
 public:
  /// `begin` holds the set-points of time 0 as an image shows them. `ramp` is that of Pace. `lead`
  /// is the time by which the motion may run ahead of the bus, above zero.
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
