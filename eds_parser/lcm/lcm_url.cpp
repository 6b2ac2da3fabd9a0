#include "eds_parser/lcm/lcm_url.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "eds_parser/values/number_in.hpp"

namespace takt {
namespace {

constexpr std::array<std::string_view, 4> schemes{"udpm", "tcpq", "memq", "file"};

std::unexpected<std::string> wrong(std::string_view text, std::string_view why) {
  return std::unexpected{"LCM url '" + std::string{text} + "': " + std::string{why}};
}

/// Reads `127.0.0.1:7700`, in which both parts are optional. Returns false if the port is invalid.
bool read_network(std::string_view network, LcmUrl& url) {
  const std::size_t colon = network.find(':');
  if (colon != 0 && !network.empty()) url.address = network.substr(0, colon);
  if (colon == network.npos) return true;
  const auto port = number_in<decltype(url.port)>(network.substr(colon + 1));
  if (port) url.port = *port;
  return port.has_value();
}

/// Returns the first number of `a.b.c.d`, or std::nullopt if the text is not a dotted address.
std::optional<unsigned> first_of_dotted(std::string_view address) {
  std::optional<unsigned> first;
  const char* at = address.data();
  const char* const end = at + address.size();
  for (int part = 0; part < 4; ++part) {
    if (part > 0 && (at == end || *at++ != '.')) return {};
    unsigned number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc{} || number > 255 || next - at > 3) return {};
    if (!first) first = number;
    at = next;
  }
  return at == end ? first : std::nullopt;
}

}  // namespace

std::expected<LcmUrl, std::string> parse_lcm_url(std::string_view text) {
  const std::size_t colon = text.find("://");
  LcmUrl url;
  url.text = text;
  url.scheme = text.substr(0, colon);
  if (colon == text.npos || std::ranges::find(schemes, url.scheme) == schemes.end()) {
    return wrong(text, "expected udpm://ADDRESS:PORT, tcpq://ADDRESS:PORT, memq:// or file://");
  }
  if (url.scheme == "memq" || url.scheme == "file") return url;

  const bool udpm = url.scheme == "udpm";
  url.address = udpm ? "239.255.76.67" : "127.0.0.1";
  url.port = udpm ? 7667 : 7700;
  std::string_view network = text.substr(colon + 3);
  network = network.substr(0, network.find('?'));
  if (!read_network(network, url)) return wrong(text, "the port is not a number of 0..65535");
  if (url.address == "localhost") url.address = "127.0.0.1";
  const auto first = first_of_dotted(url.address);
  if (!first) return wrong(text, "the address has to be dotted, like 239.255.76.67");
  if (udpm && (*first < 224 || *first > 239)) {
    return wrong(text,
                 "udpm:// takes a multicast address (224.0.0.0 to 239.255.255.255); between two "
                 "machines use one of those with ?ttl=1, on one machine tcpq://127.0.0.1:7700");
  }
  return url;
}

}  // namespace takt
