#pragma once
#include <string>
#include <takt/axis_control.hpp>
#include <takt/image_input.hpp>

namespace takt {

/// Returns a text that says why an axis is not known to be in this mode of operation (CiA 402-2,
/// 0x6060 and 0x6061), and what the user can do about it. Empty if the axis is in the mode.
std::string mode_hint(const AxisSignals& signals, const ImageInput& input, DriveMode mode);

}  // namespace takt
