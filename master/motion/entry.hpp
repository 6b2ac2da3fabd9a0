#pragma once
#include "master/motion/transfer.hpp"

namespace takt::motion {

/// The first part of a motion. This part brings the velocity and the acceleration inside their
/// limits, by a phase with jerk and then a phase with constant acceleration. Values are in the
/// units of Transfer.
struct Entry {
  double jerk = 0.0;      ///< 1, -1, or 0 if the state is inside already
  double duration = 0.0;  ///< duration of the phase with jerk
  double hold = 0.0;      ///< duration of the phase with constant acceleration
};

/// Returns the shortest entry from the start of `transfer` to a state inside the limits. A state is
/// inside if its velocity and its acceleration are inside their limits, and if the velocity stays
/// inside while the acceleration is reduced to 0. If the axis can't reach such a state without a
/// violation of the opposite limit, the entry ends before that limit.
Entry entry(const Transfer& transfer) noexcept;

}  // namespace takt::motion
