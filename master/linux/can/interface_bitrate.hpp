#pragma once
#include <string>

#include "master/linux/can/can_link.hpp"

namespace takt {

/// Checks whether set_interface_bitrate() would be allowed: it needs `ip link` and root
/// (CAP_NET_ADMIN). Returns an empty string if it is allowed or the interface has no bit rate,
/// otherwise a sentence with the reason. Changes nothing.
std::string interface_bitrate_error(const std::string& bus);
std::string interface_bitrate_error(const CanLink& link);

/// Sets the bit rate of a CAN interface (`ip link`, needs root). Leaves interfaces without a bit
/// rate unchanged (virtual interfaces and unix buses). Returns an empty string, or a sentence with
/// the commands to type.
std::string set_interface_bitrate(const std::string& bus, int bitrate);

}  // namespace takt
