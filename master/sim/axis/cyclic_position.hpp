#pragma once
#include <algorithm>

#include "master/sim/axis/motion.hpp"

namespace takt::sim {

/// The modes cyclic synchronous position and interpolated position: the demand follows a straight
/// line from one set-point to the next.
class CyclicPosition {
 public:
  void start(const Demand& demand) noexcept {
    end_ = demand.position;
    left_ = slope_ = 0;
  }
  /// Takes a set-point that the demand reaches in `period` seconds, but not faster than `limit`.
  void take(const Demand& demand, double target, double period, double limit) noexcept {
    const double wanted = (target - demand.position) / period;
    slope_ = std::clamp(wanted, -limit, limit);
    limited_ = slope_ != wanted;
    end_ = limited_ ? demand.position + slope_ * period : target;
    left_ = period;
  }
  void step(Demand& demand, double h) noexcept {
    if (left_ <= 0) {
      demand.velocity = 0;
      return;
    }
    left_ -= h;
    demand.velocity = slope_;
    demand.position = left_ <= 1e-9 ? end_ : demand.position + slope_ * h;
    if (left_ <= 1e-9) left_ = 0;
  }
  bool limited() const noexcept { return limited_; }
  /// Seconds until the demand reaches the set-point; 0 if it has reached it.
  double left() const noexcept { return left_; }
  /// Returns the velocity between the last two set-points.
  double slope() const noexcept { return slope_; }

 private:
  double end_ = 0;
  double slope_ = 0;
  double left_ = 0;
  bool limited_ = false;
};

}  // namespace takt::sim
