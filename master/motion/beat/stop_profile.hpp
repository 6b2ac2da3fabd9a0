#pragma once
#include <optional>

#include "master/motion/beat/motion_order.hpp"
#include "master/motion/position_range.hpp"

namespace takt::motion {

/// Returns the shortest motion from `from` to rest, at whatever position it ends. It has at most
/// four segments, none of which exceeds the limits of acceleration and jerk. Allocates no memory.
Profile stop_profile(const State& from, const Limits& limits) noexcept;

/// Returns the largest number of cycles after the start of `order` for which this holds: a stop
/// that begins in any of these cycles stays inside `range`. The result is at most `limit`. Returns
/// std::nullopt if there is no such stop even in the first cycle. `period` is in s. The planner
/// uses the result: for a motion that ends at rest, it must cover the whole duration; for a jog, it
/// is the `latest_stop`. Takes a time in proportion to the duration of the profile.
std::optional<CycleNumber> cycles_with_stop(const MotionOrder& order, const PositionRange& range,
                                            double period, CycleNumber limit) noexcept;

}  // namespace takt::motion
