#include "master/motion/beat/stop_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "master/motion/beat/profile_player.hpp"

namespace takt::motion {

/// Returns the profile of a stop. The axis is mirrored so that it has to brake: the acceleration
/// falls to a peak, stays there while the peak is the limit, and rises to 0.
Profile stop_profile(const State& from, const Limits& limits) noexcept {
  const double jerk = limits.jerk;
  const double coasting =
      from.velocity + from.acceleration * std::abs(from.acceleration) / (2 * jerk);
  const double sign = coasting < 0.0 ? -1.0 : 1.0;
  const double most = coasting < 0.0 ? limits.max_acceleration : -limits.min_acceleration;
  double velocity = sign * from.velocity;
  double acceleration = sign * from.acceleration;
  Profile profile;
  if (acceleration < -most) {
    const double time = (-most - acceleration) / jerk;
    profile.add(time, sign * jerk);
    velocity += time * (acceleration - most) / 2;
    acceleration = -most;
  }
  const double square = std::max(jerk * velocity + acceleration * acceleration / 2, 0.0);
  const double peak = std::min(std::sqrt(square), most);
  profile.add((acceleration + peak) / jerk, -sign * jerk);
  if (peak == most) profile.add((square - peak * peak) / (jerk * most), 0.0);
  profile.add(peak / jerk, sign * jerk);
  return profile;
}

namespace {

/// Returns the number of cycles for which an axis can keep this velocity, if a stop from `state`
/// covers the positions `stop`.
double cycles_of_cruise(const State& state, const PositionRange& stop, const PositionRange& range,
                        double period) noexcept {
  if (state.velocity == 0.0) return std::numeric_limits<double>::infinity();
  const double room = state.velocity > 0.0 ? range.max - stop.max : stop.min - range.min;
  return room / (std::abs(state.velocity) * period);
}

}  // namespace

std::optional<CycleNumber> cycles_with_stop(const MotionOrder& order, const PositionRange& range,
                                            double period, CycleNumber limit) noexcept {
  ProfilePlayer player{order.profile, order.from, order.ending};
  std::optional<CycleNumber> last;
  for (CycleNumber cycle = 0; cycle <= limit; ++cycle) {
    const State state = player.at(static_cast<double>(cycle) * period);
    const Profile stop = stop_profile(state, order.stop);
    if (!stays_inside(range, stop, state)) break;
    last = cycle;
    if (!player.is_over()) continue;
    const double more = cycles_of_cruise(state, positions_of(stop, state), range, period);
    const double rest = static_cast<double>(limit - cycle);
    return more < rest ? cycle + static_cast<CycleNumber>(std::max(more, 0.0)) : limit;
  }
  return last;
}

}  // namespace takt::motion
