#pragma once
#include <string>
#include <takt/axis.hpp>
#include <vector>

namespace takt {

/// Returns lines that tell why axes are not ready to move in cyclic synchronous position mode.
std::vector<std::string> why_not_ready(AxisGroup& group);

}  // namespace takt
