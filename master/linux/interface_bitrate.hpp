#pragma once
#include <string>

#include "master/linux/can_link.hpp"

namespace takt {

/// Whether set_interface_bitrate() would be allowed to: `ip link` and root (CAP_NET_ADMIN). Empty:
/// yes, or the interface has no bit rate. Else a sentence. Changes nothing.
std::string interface_bitrate_trouble(const std::string& bus);
std::string interface_bitrate_trouble(const CanLink& link);

/// Gives a CAN interface another bit rate (`ip link`, needs root). What has none, a virtual
/// interface or a unix bus, is left as it is. Empty, or a sentence with the commands to type.
std::string set_interface_bitrate(const std::string& bus, int bitrate);

}  // namespace takt
