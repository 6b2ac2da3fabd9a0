#pragma once
#include <array>

#include "master/motion/transfer.hpp"

namespace takt::motion {

/// Durations in s of the seven phases of a motion. Their jerks are 1, 0, -1, 0, -1, 0, 1.
using Phases = std::array<double, 7>;

/// Of all motions that make a transfer in a given time, the one that ends at the greatest position.
/// Every other end position lies between this one and that of the mirrored axis, because a mixture
/// of two motions inside the limits is inside the limits, too.
///
/// The motion has jerk 1, then -1, then 1. Where it would leave a limit, it keeps that limit: the
/// greatest acceleration before the fall, the velocity in its middle, the least acceleration behind
/// it. Its end position is a function of the duration that is convex where the acceleration changes
/// its sign, until the velocity limit is reached, and then a straight line. Shorter motions, which
/// only change a high acceleration, have concave parts: bends() has their ends.
class FarthestMotion {
 public:
  explicit FarthestMotion(const Transfer& transfer) noexcept;

  /// Where a motion ends, and how that changes with the duration.
  struct Reach {
    double distance = 0.0;
    double slope = 0.0;
  };

  /// `duration` must be one that the transfer can have.
  Reach reach(double duration) const noexcept;
  Phases phases(double duration) const noexcept;

  /// The motion has a part at the velocity limit if it lasts longer than this.
  double cruises_after() const noexcept { return cruises_after_; }
  /// Durations between which the end position is convex or concave, in ascending order. It is
  /// convex from the last one to cruises_after().
  std::array<double, 4> bends() const noexcept;

  /// Velocity of the middle of the motion, where the acceleration is 0 between its rise and its
  /// fall. The motion must have such a moment, see rises_and_falls().
  double peak_velocity(double duration) const noexcept;
  bool rises_and_falls(double duration) const noexcept;

 private:
  /// The motion below the velocity limit: accelerations before and after the fall, and the times
  /// for which they are held.
  struct Fall {
    double from = 0.0;
    double to = 0.0;
    double hold_before = 0.0;
    double hold_after = 0.0;
  };
  Fall fall(double duration) const noexcept;
  /// Returns the velocity at the begin of the fall.
  double velocity_before(const Fall& fall) const noexcept;

  Transfer transfer_;
  double gain_ = 0.0;  ///< a1^2 - a2^2 of a fall from a1 to a2 without holds
  Phases cruise_{};    ///< shortest motion that reaches the velocity limit
  double cruises_after_ = 0.0;
  double cruise_distance_ = 0.0;
};

}  // namespace takt::motion
