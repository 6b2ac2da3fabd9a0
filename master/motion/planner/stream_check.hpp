#pragma once
#include <cstdint>
#include <optional>

#include "master/motion/beat/stream.hpp"
#include "master/motion/limits.hpp"
#include "master/motion/position_range.hpp"

namespace takt::motion {

/// The reason why an axis may not follow a stream to a point.
enum class StreamDefect : std::uint8_t {
  not_finite,     ///< a number of the point is infinite or NaN
  not_later,      ///< the time of the point is not later than that of the point before
  position,       ///< the axis would leave its range of positions
  velocity,       ///< the velocity would be outside the limits on the way
  acceleration,   ///< the acceleration would be outside the limits on the way
  jerk,           ///< the jerk would be outside the limits on the way
  stop_position,  ///< a stop on the way would leave the range of positions
  stop_velocity,  ///< the velocity would be outside the limits during a stop on the way
};

/// The rules that a stream of one axis has to keep.
struct StreamRules {
  Limits limits;
  PositionRange range{};
  double period = 0.0;  ///< period of the cycle in s
};

/// Checks the curve from one point to the next, including all of its extremes, but without stops.
/// Returns the first defect, or std::nullopt if there is none. Takes a short, constant time.
std::optional<StreamDefect> defect_of_way(const StreamPoint& from, const StreamPoint& to,
                                          const StreamRules& rules) noexcept;
/// Checks a stop from the state of each cycle in which the bus thread can begin one, and returns
/// the first defect. defect_of_way() must have found no defect. Takes a time in proportion to the
/// number of cycles between the points.
std::optional<StreamDefect> defect_of_stops(const StreamPoint& from, const StreamPoint& to,
                                            const StreamRules& rules) noexcept;

}  // namespace takt::motion
