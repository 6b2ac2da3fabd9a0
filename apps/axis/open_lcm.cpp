#include "apps/axis/open_lcm.hpp"

#include "master/lcm/link/lcm_transport.hpp"
#include "master/lcm/link/lcm_url.hpp"
#include "master/lcm/tcpq/tcpq_client.hpp"

namespace takt {

std::expected<std::unique_ptr<Transport>, std::string> open_lcm(const std::string& url) {
  const auto parsed = parse_lcm_url(choose_lcm_url(url, ""));
  if (!parsed) return std::unexpected{parsed.error()};
  if (parsed->scheme == "tcpq") {
    return std::make_unique<TcpqClient>(parsed->address, parsed->port);
  }
  if (!multicast_obstacle(*parsed).empty()) {
    const auto hub = parse_lcm_url("tcpq://127.0.0.1");
    return std::make_unique<TcpqClient>(hub->address, hub->port);
  }
  auto lcm = LcmTransport::create(parsed->text);
  if (!lcm) return std::unexpected{"LCM does not accept the URL " + parsed->text};
  return lcm;
}

}  // namespace takt
