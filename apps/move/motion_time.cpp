#include "apps/move/motion_time.hpp"

#include <cmath>
#include <fmt/format.h>

namespace takt {

std::string too_long(const MotionTime& time, double limit) {
  const double whole = time.move + time.sine;
  if (whole <= limit) return {};
  std::string parts;
  if (time.move > 0.0) parts = fmt::format("the move takes {:.2f} s", time.move);
  if (time.sine > 0.0) {
    parts += fmt::format("{}one period of the sine takes {:.2f} s", parts.empty() ? "" : " and ",
                         time.sine);
  }
  return fmt::format("{}, but --for allows {:g} s: no axis moves. Give --for {:.2f}s or more",
                     parts, limit, std::ceil(whole * 100.0) / 100.0);
}

}  // namespace takt
