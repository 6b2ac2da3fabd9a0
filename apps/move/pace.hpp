#pragma once
#include <limits>

namespace takt {

enum class Hold : unsigned char { no, yes };

/// The time along a trajectory, which stands still while the motion is held. Its rate goes between
/// 0 and 1 in a ramp, so that holding and going on are smooth and the path stays the same.
class Pace {
 public:
  /// `ramp`: seconds from full speed to standstill, above zero.
  explicit Pace(double ramp) noexcept : ramp_{ramp} {}

  /// Advances by a step of real time, above zero, not beyond `latest`, where it stops at once and
  /// goes on in a ramp. Returns the time along the trajectory. Seconds.
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
