#pragma once
#include <cstddef>
#include <expected>
#include <span>
#include <string>
#include <vector>

#include "master/core/lss/lss_command.hpp"

namespace takt {

/// Reads the results from the reply of a daemon to these LSS services. A daemon runs the services
/// one after the other and stops at the first that fails. The reply must therefore have a result
/// for every service, or end with the result of the service that failed. The error continues a
/// sentence that begins with the daemon: "sent a reply ...".
std::expected<std::vector<LssResult>, std::string> lss_results(
    std::span<const std::byte> reply, std::span<const LssCommand> commands);

}  // namespace takt
