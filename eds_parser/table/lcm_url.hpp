#pragma once
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

namespace takt {

/// `scheme://address:port?...`, as far as takt has to understand it.
struct LcmUrl {
  std::string text;     ///< as it was given
  std::string scheme;   ///< "udpm", "tcpq", "memq", "file"
  std::string address;  ///< dotted IPv4; of the scheme's default where none is given
  std::uint16_t port = 0;
};

/// An error is a sentence: what is wrong and what would be right.
std::expected<LcmUrl, std::string> parse_lcm_url(std::string_view text);

}  // namespace takt
