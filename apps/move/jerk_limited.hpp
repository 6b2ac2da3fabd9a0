#pragma once

namespace takt {

/// What a motion may not exceed, in the unit of the distance and seconds; all above zero.
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

/// The fastest symmetric motion of seven constant-jerk segments from rest at 0 to rest at a
/// distance. Velocity, acceleration and jerk stay within their limits; the end is met exactly.
class JerkLimited {
 public:
  /// `distance` is not negative.
  JerkLimited(double distance, const MotionLimits& limits) noexcept;

  double duration() const noexcept { return 2.0 * ramp_ + cruise_; }
  /// Before the start and after the end: at rest there.
  MotionPoint at(double seconds) const noexcept;

 private:
  MotionPoint speeding_up(double seconds) const noexcept;

  double distance_;
  double jerk_;
  double jerk_time_ = 0.0;  // of each of the four jerk segments
  double ramp_ = 0.0;       // from rest to the highest velocity
  double cruise_ = 0.0;     // at the highest velocity
};

}  // namespace takt
