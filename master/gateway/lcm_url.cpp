#include "master/gateway/lcm_url.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <netinet/in.h>
#include <sys/socket.h>

#include "master/linux/file_descriptor.hpp"

namespace takt {
namespace {

constexpr std::string_view schemes[] = {"udpm", "tcpq", "memq", "file"};

std::unexpected<std::string> wrong(std::string_view text, std::string_view why) {
  return std::unexpected{"LCM url '" + std::string{text} + "': " + std::string{why}};
}

bool known_scheme(std::string_view scheme) noexcept {
  for (const std::string_view known : schemes) {
    if (scheme == known) return true;
  }
  return false;
}

/// `127.0.0.1:7700`, both parts optional. False: not a port.
bool read_network(std::string_view network, LcmUrl& url) {
  const std::size_t colon = network.find(':');
  if (colon != 0 && !network.empty()) url.address = network.substr(0, colon);
  if (colon == network.npos) return true;
  const std::string_view port = network.substr(colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), url.port);
  return error == std::errc{} && end == port.data() + port.size();
}

}  // namespace

std::expected<LcmUrl, std::string> parse_lcm_url(std::string_view text) {
  const std::size_t colon = text.find("://");
  LcmUrl url;
  url.text = text;
  url.scheme = text.substr(0, colon);
  if (colon == text.npos || !known_scheme(url.scheme)) {
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
  in_addr address{};
  if (::inet_pton(AF_INET, url.address.c_str(), &address) != 1) {
    return wrong(text, "the address has to be dotted, like 239.255.76.67");
  }
  if (udpm && !IN_MULTICAST(ntohl(address.s_addr))) {
    return wrong(text,
                 "udpm:// takes a multicast address (224.0.0.0 to 239.255.255.255); between two "
                 "machines use one of those with ?ttl=1, on one machine tcpq://127.0.0.1:7700");
  }
  return url;
}

std::string choose_lcm_url(const std::string& chosen, const std::string& configured) {
  if (!chosen.empty()) return chosen;
  if (!configured.empty()) return configured;
  const char* const environment = std::getenv("LCM_DEFAULT_URL");
  if (environment != nullptr && *environment != '\0') return environment;
  return std::string{lcm_default_url};
}

std::string multicast_obstacle(const LcmUrl& url) {
  const FileDescriptor socket{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(url.port);
  if (!socket || ::inet_pton(AF_INET, url.address.c_str(), &group.sin_addr) != 1) return {};
  const auto* const address = reinterpret_cast<const sockaddr*>(&group);
  if (::connect(socket.get(), address, sizeof group) == 0) return {};
  if (errno != ENETUNREACH) return std::string{"multicast: "} + std::strerror(errno);
  return "this machine has no multicast route; `ip link set lo multicast on && ip route add "
         "224.0.0.0/4 dev lo` (as root) makes one";
}

}  // namespace takt
