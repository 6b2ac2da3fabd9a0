#pragma once
#include "master/motion/axis_motion.hpp"
#include "master/motion/profile.hpp"

namespace takt::motion {

/// Returns true if a motion from `from` ends at `to` and keeps its limits, up to rounding: the
/// position to 1e-8 of the whole way (and 1e-12 of both positions; 1e-8 of them if the target
/// moves, see AxisMotion::at_target_position); the velocity and the acceleration at the end to 1e-8
/// of their limits; the limits to 1e-9, once the axis is inside them. In motions of more than 1e7
/// s, the tolerances grow with the duration. With Goal::velocity, the position does not count.
/// Limits that differ by many powers of ten can need more digits than a number has; then the
/// planner's motion is not precise.
bool is_precise(const State& from, const State& to, const Limits& limits, Goal goal,
                const Profile& profile) noexcept;

}  // namespace takt::motion
