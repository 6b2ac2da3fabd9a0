#pragma once
#include <expected>
#include <memory>
#include <string>

#include "master/lcm/transport.hpp"

namespace takt {

/// Opens the connection of an application to LCM. The address is `url`; if that is empty, it is the
/// environment variable LCM_DEFAULT_URL, or else the default of LCM. If multicast is impossible on
/// this machine, the connection goes to the hub that taktd then serves on the loopback interface
/// (tcpq://127.0.0.1). On failure, returns a sentence for the user.
std::expected<std::unique_ptr<Transport>, std::string> open_lcm(const std::string& url);

}  // namespace takt
