#pragma once
#include <string>

namespace takt {

/// Gives a CAN interface another bit rate (`ip link`, needs root). What has none, a virtual
/// interface or a unix bus, is left as it is. Empty, or a sentence with the commands to type.
std::string set_interface_bitrate(const std::string& bus, int bitrate);

}  // namespace takt
