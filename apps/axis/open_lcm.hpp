#pragma once
#include <expected>
#include <memory>
#include <string>

#include "master/gateway/transport.hpp"

namespace takt {

/// An application's connection to LCM: `url`, else LCM_DEFAULT_URL, else LCM's default. Where
/// multicast is impossible it goes to the hub that taktd serves on loopback in that case. An error
/// is a sentence.
std::expected<std::unique_ptr<Transport>, std::string> open_lcm(const std::string& url);

}  // namespace takt
