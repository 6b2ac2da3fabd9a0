#pragma once
#include <limits>

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

}  // namespace takt
