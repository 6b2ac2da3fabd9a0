#pragma once
#include <string>

#include "apps/move/move_options.hpp"
#include "apps/move/set_points/motion_limits.hpp"

namespace takt {

/// Distance, limits, amplitude and allowed following error of one axis, in its unit.
struct MoveSizes {
  double distance;
  double amplitude;
  double following_limit;
  MotionLimits limits;
};

/// Returns the sizes that the user asked for, and defaults for all others. The defaults depend on
/// the unit of the axis; an empty unit means raw counts.
MoveSizes sizes_for(const MoveOptions& options, const std::string& unit);

/// Shortest durations of the parts of a motion, in seconds. 0 means that the motion does not have
/// this part.
struct MotionTime {
  double move = 0.0;  ///< duration of the move to the point
  double sine = 0.0;  ///< duration of one period of the sine
};

/// Returns a sentence about a motion that does not end within `limit` seconds. The sentence is
/// empty if the motion fits.
std::string too_long(const MotionTime& time, double limit);

}  // namespace takt
