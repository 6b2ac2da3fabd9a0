#pragma once

namespace takt {

/// Limits that a motion does not exceed, in the unit of the distance and in seconds. All are above
/// zero.
struct MotionLimits {
  double velocity = 1.0;
  double acceleration = 1.0;
  double jerk = 1.0;
};

struct MotionPoint {
  double position = 0.0;
  double velocity = 0.0;
  double acceleration = 0.0;
};

/// The fastest symmetric motion from rest at 0 to rest at a given distance. It consists of seven
/// segments of constant jerk. Velocity, acceleration and jerk stay within their limits, and the
/// motion meets its end exactly.
class JerkLimited {
 public:
  /// `distance` is not negative.
  JerkLimited(double distance, const MotionLimits& limits) noexcept;

  /// Returns the duration in seconds.
  double duration() const noexcept { return 2.0 * ramp_ + cruise_; }
  /// Returns the point at this time since the start. Before the start and after the end, the motion
  /// rests at 0 and at the distance.
  MotionPoint at(double seconds) const noexcept;

 private:
  MotionPoint speeding_up(double seconds) const noexcept;

  double distance_;
  double jerk_;
  double jerk_time_ = 0.0;  // duration of each of the four jerk segments
  double ramp_ = 0.0;       // duration from rest to the highest velocity
  double cruise_ = 0.0;     // duration at the highest velocity
};

}  // namespace takt
