#pragma once
#include <array>

#include "master/motion/transfer.hpp"

namespace takt::motion {

/// The durations of the seven phases of a motion, in s. The jerks of the phases are 1, 0, -1, 0,
/// -1, 0, 1.
using Phases = std::array<double, 7>;

/// The motion that ends at the greatest position, of all motions that make a transfer in a given
/// time. All end positions between this one and the farthest one in the other direction are
/// possible as well, because the weighted mean of two motions inside the limits is also inside the
/// limits.
///
/// The motion has jerk 1, then -1, then 1. The part with jerk -1 is called the fall, because the
/// acceleration falls there. Where the motion would exceed a limit, it stays at the limit: at the
/// greatest acceleration before the fall, at the velocity limit in the middle of the fall, and at
/// the least acceleration after the fall. The end position is a function of the duration. If the
/// acceleration changes its sign, this function is convex up to the duration at which the motion
/// reaches the velocity limit, and a straight line for longer durations. For shorter motions, whose
/// acceleration does not change its sign, it has concave ranges; bends() returns their ends.
class FarthestMotion {
 public:
  explicit FarthestMotion(const Transfer& transfer) noexcept;

  /// The distance of a motion, and its derivative with respect to the duration.
  struct Reach {
    double distance = 0.0;
    double slope = 0.0;
  };

  /// Returns the distance for a duration. `duration` must be one of the TransferTimes.
  Reach reach(double duration) const noexcept;
  Phases phases(double duration) const noexcept;

  /// Returns the duration, in s, above which the motion has a phase at the velocity limit.
  double cruises_after() const noexcept { return cruises_after_; }
  /// Returns the durations at which the end position may change between convex and concave, in
  /// ascending order. It is convex from the last of them to cruises_after().
  std::array<double, 4> bends() const noexcept;

  /// Returns the velocity at the moment in the fall at which the acceleration is 0, which is the
  /// greatest velocity. The motion must have such a moment, see rises_and_falls().
  double peak_velocity(double duration) const noexcept;
  bool rises_and_falls(double duration) const noexcept;

 private:
  /// A motion that does not reach the velocity limit: the accelerations before and after the fall,
  /// and the times for which the axis keeps them.
  struct Fall {
    double from = 0.0;
    double to = 0.0;
    double hold_before = 0.0;
    double hold_after = 0.0;
  };
  Fall fall(double duration) const noexcept;
  /// Returns the velocity at the start of the fall.
  double velocity_before(const Fall& fall) const noexcept;

  Transfer transfer_;
  double gain_ = 0.0;  ///< (a1^2 - a2^2) for a fall from acceleration a1 to a2 without holds
  Phases cruise_{};    ///< the shortest motion that reaches the velocity limit
  double cruises_after_ = 0.0;
  double cruise_distance_ = 0.0;
};

}  // namespace takt::motion
