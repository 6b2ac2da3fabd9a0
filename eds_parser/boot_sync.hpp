#pragma once
#include "eds_parser/boot_part.hpp"

namespace takt {

/// Steps for SYNC, as the device hears or makes it: 0x1005, 0x1019, 0x1006, 0x1007.
void append_sync(const BootPart& part);

/// Steps for TIME: 0x1012.
void append_time(const BootPart& part);

}  // namespace takt
