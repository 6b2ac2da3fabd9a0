#pragma once
#include "master/motion/entry.hpp"
#include "master/motion/farthest_motion.hpp"
#include "master/motion/limits.hpp"
#include "master/motion/phase_writer.hpp"
#include "master/motion/profile.hpp"
#include "master/motion/transfer_times.hpp"

namespace takt::motion {

/// What a motion must reach beside velocity and acceleration.
enum class Goal : unsigned char {
  position,  ///< a target position
  velocity,  ///< nothing: the motion ends wherever it has the target velocity
};

/// All motions of one axis from one state to another within its limits, of any duration. From a
/// start outside the limits, the axis first returns inside in the shortest time. A start that
/// differs from the target by less than at_target is a motion without duration. It never allocates.
class AxisMotion {
 public:
  /// Part of the size of a state below which a difference counts as rounding. The sizes are those
  /// of the limits of velocity and acceleration, and of the positions.
  static constexpr double at_target = 1e-9;
  static constexpr double at_target_position = 1e-8;

  /// Limits and target must be sound, see defect_of().
  AxisMotion(const State& from, const State& to, const Limits& limits, Goal goal) noexcept;

  /// Returns the shortest possible duration that is at least `duration`, in s. Some
  /// durations in between are impossible: after them, a moving axis has passed its target and has
  /// not returned to it yet. Always finite.
  double possible(double duration) const noexcept;

  /// Returns a motion with this duration, which must be a possible one.
  Profile profile(double duration) const noexcept;

 private:
  double distance_up(double time) const noexcept { return up_.reach(time).distance; }
  double distance_down(double time) const noexcept { return -down_.reach(time).distance; }
  /// Largest error of a distance by rounding, for motions of this duration.
  double rounding(double time) const noexcept;

  void add_phases(const Phases& phases, double direction, PhaseWriter& writer) const noexcept;

  double jerk_;
  Entry entry_;
  double entry_time_ = 0.0;
  Transfer transfer_;           ///< after the entry
  long double entered_ = 0.0L;  ///< acceleration after the entry, exactly
  double distance_ = 0.0;       ///< of the transfer
  Goal goal_;
  bool at_target_;  ///< nothing is to be moved
  TransferTimes times_;
  FarthestMotion up_;
  FarthestMotion down_;
};

}  // namespace takt::motion
