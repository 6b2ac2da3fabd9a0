#pragma once
#include <string>

#include "apps/takt/trajectory/trajectory_line.hpp"

namespace takt {

/// Returns a picture of a trajectory as an SVG document: position, velocity, acceleration and jerk
/// of all axes over the time.
std::string trajectory_svg(const TrajectoryAnswer& answer);

}  // namespace takt
