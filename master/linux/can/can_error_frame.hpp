#pragma once
#include <linux/can.h>

#include "master/rt/port.hpp"

namespace takt {

/// The classes of error frames that a Port requests: changes of the controller state. They exclude
/// single bus errors, because a loose terminator causes thousands of them per second.
inline constexpr canid_t state_error_classes =
    0x00000004U /*CAN_ERR_CRTL*/ | 0x00000040U /*CAN_ERR_BUSOFF*/ |
    0x00000100U /*CAN_ERR_RESTARTED*/ | 0x00000001U /*CAN_ERR_TX_TIMEOUT*/;

/// Updates the condition from one error frame of the kernel (CAN_ERR_FLAG set). linux/can/error.h
/// describes its bytes.
void apply_error_frame(const can_frame& frame, PortCondition& condition) noexcept;

}  // namespace takt
