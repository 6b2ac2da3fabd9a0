#pragma once
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

namespace takt {

inline constexpr std::string_view lcm_default_url = "udpm://239.255.76.67:7667?ttl=0";

/// `scheme://address:port?...`, as far as takt has to understand it.
struct LcmUrl {
  std::string text;     ///< as it was given
  std::string scheme;   ///< "udpm", "tcpq", "memq", "file"
  std::string address;  ///< dotted IPv4; of the scheme's default where none is given
  std::uint16_t port = 0;
};

/// An error is a sentence: what is wrong and what would be right.
std::expected<LcmUrl, std::string> parse_lcm_url(std::string_view text);

/// The first that is not empty: `chosen` (command line), `configured` (network file),
/// LCM_DEFAULT_URL, LCM's own default.
std::string choose_lcm_url(const std::string& chosen, const std::string& configured);

/// Nothing, or a sentence on why multicast to this address can't work on this machine, with the
/// command that mends it.
std::string multicast_obstacle(const LcmUrl& url);

}  // namespace takt
