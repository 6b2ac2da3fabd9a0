#pragma once
#include <string>

#include "apps/move/options.hpp"

namespace takt {

/// Distance, limits, amplitude and allowed following error of one axis, in its unit.
struct MoveSizes {
  double distance;
  double amplitude;
  double following_limit;
  MotionLimits limits;
};

/// As the user asked; defaults by the axis' unit, empty: counts.
MoveSizes sizes_for(const MoveOptions& options, const std::string& unit);

}  // namespace takt
