#pragma once
#include <algorithm>
#include <cmath>
#include <span>

#include "master/motion/trajectory.hpp"

namespace takt::motion {

/// The errors of a motion, computed with more digits than the planner has.
struct Verdict {
  double end_error = 0.0;  ///< of position, velocity and acceleration, relative to their sizes
  double excess = 0.0;     ///< beyond a limit, relative to the limit, once the axis is inside
};

/// Integrates a motion and measures its errors.
class Judge {
 public:
  Judge(const AxisTask& task, std::span<const Segment> segments) : task_{task} {
    v_ = task.from.velocity;
    a_ = task.from.acceleration;
    steepest_ = std::abs(a_);
    inside_ = is_inside();
    long double way = 0;
    for (const Segment& segment : segments) way += follow(segment);
    const Limits& l = task.limits;
    const long double from = task.from.position;
    const long double to = task.to.position;
    const long double positions = std::max(std::abs(from), std::abs(to));
    // A moving axis counts as at its target if the difference is small beside its position.
    const bool rests = task.to.velocity == 0 && task.to.acceleration == 0;
    const long double size = rests ? path_ + 1e-4L * positions : std::max(path_, positions);
    // The rounding of an acceleration in its 18th digit moves the end. This distance is no error.
    const long double miss =
        std::max(std::abs(way - (to - from)) - 1e-18L * steepest_ * time_ * time_, 0.0L);
    verdict_.end_error = static_cast<double>(std::max(
        {size > 0 ? miss / size : miss,
         std::abs(v_ - task.to.velocity) / std::max(l.max_velocity, -l.min_velocity),
         std::abs(a_ - task.to.acceleration) / std::max(l.max_acceleration, -l.min_acceleration)}));
  }

  const Verdict& verdict() const { return verdict_; }

 private:
  /// This is less than the permitted excess, so that the rounding of a start state never counts as
  /// an excess.
  static constexpr long double tolerance = 1.0L + 5e-10L;

  /// Returns true if velocity and acceleration are inside and can stay there.
  bool is_inside() const {
    const Limits& l = task_.limits;
    const long double later = v_ + a_ * std::abs(a_) / 2 / l.jerk;
    return a_ <= l.max_acceleration * tolerance && a_ >= l.min_acceleration * tolerance &&
           std::max(v_, later) <= l.max_velocity * tolerance &&
           std::min(v_, later) >= l.min_velocity * tolerance;
  }

  void look(long double velocity, long double acceleration) {
    const Limits& l = task_.limits;
    for (const long double excess :
         {velocity / l.max_velocity, velocity / l.min_velocity, acceleration / l.max_acceleration,
          acceleration / l.min_acceleration}) {
      verdict_.excess = std::max(verdict_.excess, static_cast<double>(excess - 1));
    }
  }

  /// Returns the distance of a segment.
  long double follow(const Segment& segment) {
    const long double t = segment.duration;
    const long double j = segment.jerk;
    if (inside_) {
      verdict_.excess =
          std::max(verdict_.excess, static_cast<double>(std::abs(j) / task_.limits.jerk - 1));
    }
    long double fastest = std::abs(v_);
    const long double turn = j == 0 ? -1 : -a_ / j;
    if (turn > 0 && turn < t) {
      const long double velocity = v_ + turn * (a_ + turn * j / 2);
      fastest = std::max(fastest, std::abs(velocity));
      if (inside_) look(velocity, 0);
    }
    const long double distance = t * (v_ + t * (a_ / 2 + t * j / 6));
    v_ += t * (a_ + t * j / 2);
    a_ += t * j;
    time_ += t;
    steepest_ = std::max(steepest_, std::abs(a_));
    path_ += t * std::max(fastest, std::abs(v_));  // also where the axis comes back
    if (inside_) look(v_, a_);
    inside_ = inside_ || is_inside();
    return distance;
  }

  AxisTask task_;
  long double v_ = 0;
  long double a_ = 0;
  long double path_ = 0;
  long double time_ = 0;
  long double steepest_ = 0;
  bool inside_ = false;
  Verdict verdict_;
};

}  // namespace takt::motion
