#pragma once
#include "eds_parser/plan/boot/boot_part.hpp"

namespace takt {

/// Appends the steps for SYNC if the device consumes or produces it: 0x1005, 0x1019, 0x1006,
/// 0x1007.
void append_sync(const BootPart& part);

/// Appends the steps for TIME: 0x1012.
void append_time(const BootPart& part);

}  // namespace takt
