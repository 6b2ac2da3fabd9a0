#include "master/lcm/link/open_transport.hpp"

#include <utility>

#include "master/lcm/link/lcm_transport.hpp"
#include "master/lcm/link/lcm_url.hpp"
#include "master/lcm/tcpq/tcpq_client.hpp"

namespace takt {

std::expected<std::unique_ptr<Transport>, std::string> open_transport(const LcmUrl& url) {
  if (url.scheme == "tcpq") return std::make_unique<TcpqClient>(url.address, url.port);
  if (url.scheme == "udpm") {
    std::string obstacle = multicast_obstacle(url);
    if (!obstacle.empty()) return std::unexpected{std::move(obstacle)};
  }
  auto lcm = LcmTransport::create(url.text);
  if (!lcm) return std::unexpected{std::string{}};
  return lcm;
}

}  // namespace takt
