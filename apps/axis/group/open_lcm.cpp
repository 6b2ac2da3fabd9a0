#include <takt/lcm.hpp>

#include "master/lcm/link/lcm_url.hpp"
#include "master/lcm/link/open_transport.hpp"

namespace takt {

std::expected<std::unique_ptr<Transport>, std::string> open_lcm(const std::string& url) {
  const auto parsed = parse_lcm_url(choose_lcm_url(url, ""));
  if (!parsed) return std::unexpected{parsed.error()};
  auto transport = open_transport(*parsed);
  if (transport) return transport;
  const bool has_no_multicast = !transport.error().empty();
  if (has_no_multicast) return open_transport(parse_lcm_url("tcpq://127.0.0.1").value());
  return std::unexpected{"LCM does not accept the URL " + parsed->text};
}

}  // namespace takt
