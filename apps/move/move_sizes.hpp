#pragma once
#include <string>

#include "apps/move/move_options.hpp"

namespace takt {

/// Distance, limits, amplitude and allowed following error of one axis, in its unit.
struct MoveSizes {
  double distance;
  double amplitude;
  double following_limit;
  MotionLimits limits;
};

/// Returns the sizes that the user asked for, and defaults for all others. The defaults depend on
/// the unit of the axis; an empty unit stands for raw counts.
MoveSizes sizes_for(const MoveOptions& options, const std::string& unit);

}  // namespace takt
