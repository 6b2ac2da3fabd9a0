#include "master/motion/beat/motion_order.hpp"

#include <algorithm>
#include <cmath>

namespace takt::motion {
namespace {

bool is_finite(const State& state) noexcept {
  return std::isfinite(state.position) && std::isfinite(state.velocity) &&
         std::isfinite(state.acceleration);
}

/// Returns true if a stop along these limits is possible. A comparison with NaN is false, so NaN
/// permits no stop.
bool permit_stop(const Limits& limits) noexcept {
  return limits.jerk > 0.0 && limits.max_acceleration > 0.0 && limits.min_acceleration < 0.0 &&
         limits.max_velocity > 0.0 && limits.min_velocity < 0.0;
}

}  // namespace

bool is_sound(const MotionOrder& order) noexcept {
  const auto good = [](const Segment& segment) {
    return std::isfinite(segment.duration) && std::isfinite(segment.jerk);
  };
  return order.id != 0 && order.axes != 0 && order.sender < max_axes && is_finite(order.from) &&
         std::ranges::all_of(order.profile.segments(), good) && permit_stop(order.stop) &&
         order.max_following_error > 0.0 && (order.ending != Ending::gear || is_sound(order.gear));
}

}  // namespace takt::motion
