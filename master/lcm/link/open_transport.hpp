#pragma once
#include <expected>
#include <memory>
#include <string>
#include <takt/lcm.hpp>

#include "eds_parser/lcm/lcm_url.hpp"

namespace takt {

/// Opens the transport that the URL names: a hub by tcpq://, everything else by LCM itself. The
/// error is what makes multicast impossible on this machine, see multicast_obstacle(). It is empty
/// if LCM refuses the URL.
std::expected<std::unique_ptr<Transport>, std::string> open_transport(const LcmUrl& url);

}  // namespace takt
