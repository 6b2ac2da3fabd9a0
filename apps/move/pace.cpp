#include "apps/move/pace.hpp"

#include <algorithm>

namespace takt {

double Pace::step(double seconds, Hold hold) noexcept {
  const double change = seconds / ramp_;
  const double next =
      hold == Hold::yes ? std::max(0.0, rate_ - change) : std::min(1.0, rate_ + change);
  time_ += seconds * (rate_ + next) / 2.0;
  rate_ = next;
  return time_;
}

}  // namespace takt
