#pragma once
#include <string>
#include <string_view>

#include "eds_parser/lcm/lcm_url.hpp"

namespace takt {

inline constexpr std::string_view lcm_default_url = "udpm://239.255.76.67:7667?ttl=0";

/// Returns the first non-empty URL of: `chosen` (command line), `configured` (network file),
/// LCM_DEFAULT_URL, LCM's own default.
std::string choose_lcm_url(const std::string& chosen, const std::string& configured);

/// Returns true if choose_lcm_url() takes LCM_DEFAULT_URL.
bool lcm_url_is_from_environment(const std::string& chosen, const std::string& configured);

/// Returns why multicast to this address cannot work on this machine, with the command that
/// corrects it. Empty if there is no obstacle.
std::string multicast_obstacle(const LcmUrl& url);

}  // namespace takt
