#pragma once
#include <string>

#include "apps/axis/axis_control.hpp"
#include "apps/axis/axis_signals.hpp"
#include "apps/axis/image_input.hpp"

namespace takt {

/// Why an axis is not known to be in this mode of operation (CiA 402-2, 0x6060 and 0x6061), and
/// what to do about it. Empty: it is in the mode.
std::string mode_hint(const AxisSignals& signals, const ImageInput& input, DriveMode mode);

}  // namespace takt
