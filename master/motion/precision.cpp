#include "master/motion/precision.hpp"

#include <algorithm>
#include <cmath>

namespace takt::motion {
namespace {

constexpr double end_tolerance = 1e-8;
constexpr double limit_tolerance = 1e-9;
/// This tolerance is below limit_tolerance, so that a state that counts as inside does not exceed a
/// limit.
constexpr double inside_tolerance = 5e-10;
constexpr double long_duration = 1e7;  ///< s, above which the tolerances grow

/// Returns the limits, each a bit farther from 0.
Limits widened(const Limits& limits, double tolerance) noexcept {
  const double factor = 1.0 + tolerance;
  return {.max_velocity = limits.max_velocity * factor,
          .min_velocity = limits.min_velocity * factor,
          .max_acceleration = limits.max_acceleration * factor,
          .min_acceleration = limits.min_acceleration * factor,
          .jerk = limits.jerk};
}

/// Follows a motion with more digits than the planner has.
class Follower {
 public:
  Follower(const State& from, const Limits& limits, double tolerance) noexcept
      : inner_{widened(limits, inside_tolerance)},
        outer_{widened(limits, tolerance)},
        velocity_{from.velocity},
        acceleration_{from.acceleration},
        steepest_{std::abs(from.acceleration)},
        inside_{is_inside()} {}

  void follow(const Segment& segment) noexcept {
    const long double t = segment.duration;
    const long double j = segment.jerk;
    const long double end = acceleration_ + t * j;
    long double fastest = std::abs(velocity_);
    if ((acceleration_ > 0.0L) != (end > 0.0L) && j != 0.0L) {
      const long double turn = velocity_ - acceleration_ * acceleration_ / (2 * j);
      fastest = std::max(fastest, std::abs(turn));
      look(turn, 0.0L);
    }
    distance_ += t * (velocity_ + t * (2 * acceleration_ + end) / 6);
    velocity_ += t * (acceleration_ + end) / 2;
    acceleration_ = end;
    duration_ += t;
    steepest_ = std::max(steepest_, std::abs(end));
    way_ += t * std::max(fastest, std::abs(velocity_));
    look(velocity_, acceleration_);
  }

  /// Returns true if the motion has never left its limits after it was inside them.
  bool kept_limits() const noexcept { return kept_; }

  bool ends_at(const State& from, const State& to, const Limits& limits, Goal goal,
               double tolerance) const noexcept {
    const long double begin = from.position;
    const long double positions = std::max(std::abs(from.position), std::abs(to.position));
    const bool rests = to.velocity == 0.0 && to.acceleration == 0.0;
    const long double size = rests ? way_ + 1e-4L * positions : std::max(way_, positions);
    // The change of the end position if an acceleration is rounded in its 18th digit.
    const long double drift = 1e-18L * steepest_ * duration_ * duration_;
    const auto is_near = [&](long double miss, long double of, long double more = 0.0L) {
      return std::abs(miss) <= tolerance * of + more;
    };
    return (goal == Goal::velocity || is_near(distance_ - (to.position - begin), size, drift)) &&
           is_near(velocity_ - to.velocity, std::max(limits.max_velocity, -limits.min_velocity)) &&
           is_near(acceleration_ - to.acceleration,
                   std::max(limits.max_acceleration, -limits.min_acceleration));
  }

 private:
  /// Returns true if the axis is inside its limits and can stay there.
  bool is_inside() const noexcept {
    const long double later = velocity_ + acceleration_ * std::abs(acceleration_) / 2 / inner_.jerk;
    return is_between(inner_, velocity_, acceleration_) && is_between(inner_, later, 0.0L);
  }

  static bool is_between(const Limits& limits, long double velocity,
                         long double acceleration) noexcept {
    return velocity >= limits.min_velocity && velocity <= limits.max_velocity &&
           acceleration >= limits.min_acceleration && acceleration <= limits.max_acceleration;
  }

  void look(long double velocity, long double acceleration) noexcept {
    if (inside_) {
      kept_ = kept_ && is_between(outer_, velocity, acceleration);
    } else {
      inside_ = is_inside();
    }
  }

  Limits inner_;
  Limits outer_;
  long double velocity_;
  long double acceleration_;
  long double steepest_;
  long double duration_ = 0.0L;
  long double distance_ = 0.0L;
  /// An upper bound of the length of the whole path. The parts on which the axis moves back count
  /// as well.
  long double way_ = 0.0L;
  bool inside_;
  bool kept_ = true;
};

}  // namespace

bool is_precise(const State& from, const State& to, const Limits& limits, Goal goal,
                const Profile& profile) noexcept {
  const double growth = std::max(profile.duration() / long_duration, 1.0);
  Follower follower{from, limits, limit_tolerance * growth};
  for (const Segment& segment : profile.segments()) follower.follow(segment);
  return follower.kept_limits() && follower.ends_at(from, to, limits, goal, end_tolerance * growth);
}

}  // namespace takt::motion
