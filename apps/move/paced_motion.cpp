#include "apps/move/paced_motion.hpp"

namespace takt {

double PacedMotion::step(double seconds, Hold hold) noexcept {
  const double before = pace_.time();
  const double now = pace_.step(seconds, hold, taken_.time() + lead_);
  refused_ = now == before && hold == Hold::no ? refused_ + seconds : 0.0;
  return now;
}

}  // namespace takt
