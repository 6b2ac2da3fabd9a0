#pragma once
#include <string>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/firmware.hpp"

namespace takt {

/// A device has another firmware than its device data were taken for: what follows, what to write.
std::string firmware_text(const FirmwarePlan& plan, const Firmware& is);

}  // namespace takt
