#pragma once
#include <linux/can.h>

#include "master/rt/port.hpp"

namespace takt {

/// The classes of error frames that a Port asks for: changes of the controller's state. Single bus
/// errors are left out: a loose terminator makes thousands of them a second.
inline constexpr canid_t state_error_classes =
    0x00000004U /*CAN_ERR_CRTL*/ | 0x00000040U /*CAN_ERR_BUSOFF*/ |
    0x00000100U /*CAN_ERR_RESTARTED*/ | 0x00000001U /*CAN_ERR_TX_TIMEOUT*/;

/// Brings the news up to date with one error frame of the kernel (CAN_ERR_FLAG set).
/// linux/can/error.h says what its bytes mean.
void apply_error_frame(const can_frame& frame, PortNews& news) noexcept;

}  // namespace takt
