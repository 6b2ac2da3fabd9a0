#pragma once
#include <algorithm>
#include <cmath>
#include <span>

#include "master/motion/trajectory.hpp"

namespace takt::motion {

/// What a motion does beside what it should, computed with more digits than the planner has.
struct Verdict {
  double end_error = 0.0;  ///< of position, velocity and acceleration, relative to their sizes
  double excess = 0.0;     ///< beyond a limit, relative to the limit, once the axis is inside
};

/// Integrates a motion and looks at it.
class Judge {
 public:
  Judge(const AxisTask& task, std::span<const Segment> segments) : task_{task} {
    v_ = task.from.velocity;
    a_ = task.from.acceleration;
    inside_ = is_inside();
    long double position = task.from.position;
    for (const Segment& segment : segments) position += follow(segment);
    const Limits& l = task.limits;
    const long double size =
        std::max({path_, std::abs(static_cast<long double>(task.from.position)),
                  std::abs(static_cast<long double>(task.to.position)),
                  static_cast<long double>(l.max_velocity * l.max_velocity / l.max_acceleration)});
    verdict_.end_error = static_cast<double>(std::max(
        {std::abs(position - task.to.position) / size,
         std::abs(v_ - task.to.velocity) / std::max(l.max_velocity, -l.min_velocity),
         std::abs(a_ - task.to.acceleration) / std::max(l.max_acceleration, -l.min_acceleration)}));
  }

  const Verdict& verdict() const { return verdict_; }

 private:
  static constexpr long double tolerance = 1.0L + 1e-9L;

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
      const long double turn = j == 0 ? -1 : -a_ / j;
      if (turn > 0 && turn < t) look(v_ + turn * (a_ + turn * j / 2), 0);
    }
    const long double distance = t * (v_ + t * (a_ / 2 + t * j / 6));
    v_ += t * (a_ + t * j / 2);
    a_ += t * j;
    path_ += std::abs(distance);
    if (inside_) look(v_, a_);
    inside_ = inside_ || is_inside();
    return distance;
  }

  AxisTask task_;
  long double v_ = 0;
  long double a_ = 0;
  long double path_ = 0;
  bool inside_ = false;
  Verdict verdict_;
};

}  // namespace takt::motion
