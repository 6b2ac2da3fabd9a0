#pragma once
#include "eds_parser/boot_part.hpp"

namespace takt {

/// Steps for heartbeat and guarding both ways, and for what the device does after an error: 0x1017,
/// 0x1016, 0x100C, 0x100D, 0x1029.
void append_error_control(const BootPart& part);

/// Steps for identifier and inhibit time of EMCY: 0x1014, 0x1015.
void append_emergency(const BootPart& part);

}  // namespace takt
