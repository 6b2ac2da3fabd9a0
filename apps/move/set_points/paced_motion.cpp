#include "apps/move/set_points/paced_motion.hpp"

#include <algorithm>
#include <cmath>

namespace takt {

double Pace::step(double seconds, Hold hold, double latest) noexcept {
  const double before = time_;
  const double end = hold == Hold::yes ? 0.0 : 1.0;
  const double on_ramp = std::min(seconds, std::abs(end - rate_) * ramp_);
  const double next = rate_ + std::copysign(on_ramp / ramp_, end - rate_);
  time_ += on_ramp * (rate_ + next) / 2.0 + (seconds - on_ramp) * end;
  rate_ = on_ramp < seconds ? end : std::clamp(next, 0.0, 1.0);
  if (time_ > latest) {
    time_ = std::max(before, latest);
    rate_ = time_ > before ? (time_ - before) / seconds : 0.0;
  }
  return time_;
}

double PacedMotion::step(double seconds, Hold hold) noexcept {
  const double before = pace_.time();
  const double now = pace_.step(seconds, hold, taken_.time() + lead_);
  refused_ = now == before && hold == Hold::no ? refused_ + seconds : 0.0;
  return now;
}

}  // namespace takt
