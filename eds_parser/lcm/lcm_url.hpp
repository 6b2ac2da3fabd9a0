#pragma once
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

namespace takt {

/// The parts of `scheme://address:port?...` that takt needs.
struct LcmUrl {
  std::string text;     ///< the unchanged text
  std::string scheme;   ///< "udpm", "tcpq", "memq", "file"
  std::string address;  ///< dotted IPv4; the scheme's default if none is given
  std::uint16_t port = 0;
};

/// Parses a URL. The error is a sentence that says what is wrong and what is expected.
std::expected<LcmUrl, std::string> parse_lcm_url(std::string_view text);

}  // namespace takt
