#pragma once
#include "eds_parser/plan/boot/boot_part.hpp"

namespace takt {

/// Appends the steps for heartbeat and guarding in both directions, and for the behaviour of the
/// device after an error: 0x1017, 0x1016, 0x100C, 0x100D, 0x1029.
void append_error_control(const BootPart& part);

/// Appends the steps for the identifier and the inhibit time of EMCY: 0x1014, 0x1015.
void append_emergency(const BootPart& part);

}  // namespace takt
