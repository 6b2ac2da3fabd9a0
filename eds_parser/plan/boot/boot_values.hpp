#pragma once
#include "eds_parser/plan/boot/boot_compiler.hpp"
#include "eds_parser/plan/boot/boot_steps.hpp"

namespace takt {

/// Appends steps that write values: the ParameterValues of a DCF, the interpolation period of
/// drives, the values of the device data, then the list `sdo:` in its order. Each value is checked
/// against the type, access and limits of the EDS.
void append_values(const NodeSource& node, const BootContext& context, BootSteps& steps,
                   NetworkReport& report);

}  // namespace takt
