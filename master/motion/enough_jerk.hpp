#pragma once
#include <algorithm>

#include "master/motion/limits.hpp"
#include "master/motion/profile.hpp"

namespace takt::motion {

/// Returns the limits of a new motion that begins in the state `from` of a motion with the limits
/// `running`. An axis that accelerates gains velocity until its acceleration is 0, and it gains
/// more if the jerk is lower. Therefore the jerk of the new motion is raised until the axis stays
/// within the velocity limits of both motions. It is not raised above the jerk of the running
/// motion.
inline Limits with_enough_jerk(Limits limits, const State& from, const Limits& running) noexcept {
  if (from.acceleration == 0.0) return limits;
  const double room = from.acceleration > 0.0
                          ? std::max(limits.max_velocity, running.max_velocity) - from.velocity
                          : from.velocity - std::min(limits.min_velocity, running.min_velocity);
  const double needed =
      room > 0.0 ? from.acceleration * from.acceleration / (2 * room) : running.jerk;
  limits.jerk = std::max(limits.jerk, std::min(needed, running.jerk));
  return limits;
}

}  // namespace takt::motion
