#pragma once
#include "master/motion/axis_motion.hpp"
#include "master/motion/profile.hpp"

namespace takt::motion {

/// Returns true if a motion from `from` ends at `to` and keeps its limits, up to rounding:
/// - The position at the end may differ by 1e-8 of the whole way and by 1e-12 of both positions. If
///   the target moves, it may differ by 1e-8 of the positions, see AxisMotion::at_target_position.
///   With Goal::velocity, the position does not count.
/// - The velocity and the acceleration at the end may differ by 1e-8 of their limits.
/// - Once the axis is inside its limits, it may exceed them by 1e-9.
/// In motions of more than 1e7 s, these tolerances grow with the duration. Limits that differ by
/// many powers of ten can need more digits than a number has; then the planner's motion is not
/// precise.
bool is_precise(const State& from, const State& to, const Limits& limits, Goal goal,
                const Profile& profile) noexcept;

}  // namespace takt::motion
