#pragma once
#include <string>
#include <takt/axis.hpp>
#include <vector>

namespace takt {

/// Returns a text that says why an axis is not known to be in this mode of operation (CiA 402-2,
/// 0x6060 and 0x6061), and what the user can do about it. Empty if the axis is in the mode.
std::string mode_hint(const AxisSignals& signals, const ImageInput& input, DriveMode mode);

/// Returns lines that tell why axes are not ready to move in cyclic synchronous position mode.
std::vector<std::string> why_not_ready(AxisGroup& group);

}  // namespace takt
