#pragma once
#include <optional>

#include "master/motion/beat/motion_order.hpp"
#include "master/motion/position_range.hpp"

namespace takt::motion {

/// Returns the shortest motion from `from` to rest, wherever that is: at most four segments, of
/// which none exceeds the limits of acceleration and jerk. It never allocates.
Profile stop_profile(const State& from, const Limits& limits) noexcept;

/// Returns the number of cycles after the begin of `order` up to which a stop from the state of
/// each cycle stays inside `range`, at most `limit`; empty if there is none even in the first.
/// `period` is in s. The planner needs it: a motion that ends at rest must have it for its whole
/// duration, and that of a jog is its `latest_stop`. Takes a time in proportion to the duration of
/// the profile.
std::optional<CycleNumber> cycles_with_stop(const MotionOrder& order, const PositionRange& range,
                                            double period, CycleNumber limit) noexcept;

}  // namespace takt::motion
