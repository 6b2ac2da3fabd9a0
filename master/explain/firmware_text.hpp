#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/firmware.hpp"

namespace takt {

/// Describes that a device has another firmware than the one for which its device data were made:
/// the consequences, and what the user can write in the network file.
std::string firmware_text(const FirmwarePlan& plan, const Firmware& is);

}  // namespace takt
