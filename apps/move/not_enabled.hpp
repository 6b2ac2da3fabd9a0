#pragma once
#include <string>
#include <vector>

#include "apps/axis/axis_group.hpp"

namespace takt {

/// Returns lines that tell why axes are not ready to move in cyclic synchronous position mode.
std::vector<std::string> why_not_ready(AxisGroup& group);

}  // namespace takt
