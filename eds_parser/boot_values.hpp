#pragma once
#include "eds_parser/boot_compiler.hpp"
#include "eds_parser/boot_steps.hpp"

namespace takt {

/// Steps that write values: ParameterValues of a DCF, the interpolation period of drives, those
/// of the device data, then the list `sdo:` in its order. Values are checked against type, access
/// and limits of the EDS.
void append_values(const NodeSource& node, const BootContext& context, BootSteps& steps,
                   NetworkReport& report);

}  // namespace takt
