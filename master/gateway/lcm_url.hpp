#pragma once
#include <string>
#include <string_view>

#include "eds_parser/table/lcm_url.hpp"

namespace takt {

inline constexpr std::string_view lcm_default_url = "udpm://239.255.76.67:7667?ttl=0";

/// The first that is not empty: `chosen` (command line), `configured` (network file),
/// LCM_DEFAULT_URL, LCM's own default.
std::string choose_lcm_url(const std::string& chosen, const std::string& configured);

/// Nothing, or a sentence on why multicast to this address can't work on this machine, with the
/// command that mends it.
std::string multicast_obstacle(const LcmUrl& url);

}  // namespace takt
