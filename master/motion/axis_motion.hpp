#pragma once
#include "master/motion/entry.hpp"
#include "master/motion/farthest_motion.hpp"
#include "master/motion/limits.hpp"
#include "master/motion/phase_writer.hpp"
#include "master/motion/profile.hpp"
#include "master/motion/transfer_times.hpp"

namespace takt::motion {

/// What a motion must reach in addition to the velocity and the acceleration of its target.
enum class Goal : unsigned char {
  position,  ///< a target position
  velocity,  ///< no position: the motion ends at the position where it reaches the target velocity
};

/// All possible motions of one axis from one state to another within its limits. They differ in
/// their duration. If the start is outside the limits, the axis first returns inside them in the
/// shortest time. If start and target differ by less than at_target, the axis does not move and the
/// duration may be 0. No function allocates memory.
class AxisMotion {
 public:
  /// The largest relative difference of velocity and acceleration that counts as rounding. It is
  /// relative to the difference between the upper and the lower limit. at_target_position is the
  /// same for positions and is relative to the larger of both positions. at_rest_position applies
  /// instead if the target is at rest, because a small difference then needs little time.
  static constexpr double at_target = 1e-9;
  static constexpr double at_target_position = 1e-8;
  static constexpr double at_rest_position = 1e-12;

  /// The limits and the target must have no defect, see defect_of().
  AxisMotion(const State& from, const State& to, const Limits& limits, Goal goal) noexcept;

  /// Returns the shortest possible duration that is at least `duration`, in s. The result is always
  /// finite. Some durations are impossible although a shorter one is possible: with more time, a
  /// moving axis passes its target and needs a certain time to return to it.
  double possible(double duration) const noexcept;

  /// Returns a motion with this duration, which must be a result of possible().
  Profile profile(double duration) const noexcept;

 private:
  double distance_up(double time) const noexcept { return up_.reach(time).distance; }
  double distance_down(double time) const noexcept { return -down_.reach(time).distance; }
  /// Returns the largest error that rounding can cause in the distance of a motion of this
  /// duration.
  double rounding(double time) const noexcept;

  void add_phases(const Phases& phases, double direction, PhaseWriter& writer) const noexcept;

  double jerk_;
  Entry entry_;
  double entry_time_ = 0.0;
  Transfer transfer_;           ///< transfer from the end of the entry to the target
  long double entered_ = 0.0L;  ///< acceleration after the entry without rounding
  double distance_ = 0.0;       ///< distance of the transfer
  Goal goal_;
  bool at_target_;  ///< The axis is already at its target.
  TransferTimes times_;
  FarthestMotion up_;
  FarthestMotion down_;
};

}  // namespace takt::motion
