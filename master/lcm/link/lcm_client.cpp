#include "master/lcm/link/lcm_client.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "master/lcm/envelope/checked_transport.hpp"
#include "master/lcm/link/lcm_url.hpp"
#include "master/lcm/link/open_transport.hpp"
#include "master/lcm/tcpq/tcpq_client.hpp"
#include "master/linux/clock.hpp"

namespace takt {
std::expected<LcmClient, std::string> LcmClient::open(
    const std::string& url, const std::vector<std::string>& patterns,
    const std::optional<WatchedKeyFile>& signers) {
  const auto parsed = parse_lcm_url(choose_lcm_url(url, {}));
  if (!parsed) return std::unexpected{parsed.error()};
  LcmClient client;
  auto first = open_transport(*parsed);
  if (first) client.transports_.push_back(std::move(*first));
  const bool is_given = !url.empty() || lcm_url_is_from_environment({}, {});
  const bool hub =
      !is_given && tcpq_server_answers("127.0.0.1", tcpq::default_port, hub_answer_limit);
  if (hub) {
    client.transports_.push_back(std::make_unique<TcpqClient>("127.0.0.1", tcpq::default_port));
  }
  if (client.transports_.empty()) {
    const std::string& obstacle = first.error();
    return std::unexpected{parsed->text + ": " +
                           (obstacle.empty() ? "LCM can't be opened" : obstacle) +
                           ". No hub answers at tcpq://127.0.0.1:7700 either: is taktd running?"};
  }
  for (auto& transport : client.transports_) {
    if (signers) {
      transport = std::make_unique<CheckedTransport>(std::move(transport), *signers);
    }
    for (const std::string& pattern : patterns) transport->subscribe(pattern);
  }
  return client;
}

void LcmClient::publish(const std::string& channel, std::span<const std::byte> data) {
  for (const auto& transport : transports_) transport->publish(channel, data);
}

void LcmClient::serve(const MessageHandler& handler, Time until, int also) {
  bool some = false;
  const MessageHandler noticing = [&](std::string_view channel, std::span<const std::byte> data) {
    some = true;
    handler(channel, data);
  };
  for (;;) {
    for (const auto& transport : transports_) transport->serve(noticing);
    const Time now = monotonic_now();
    if (some || now >= until) return;
    std::vector<pollfd> descriptors;
    if (also >= 0) descriptors.push_back({.fd = also, .events = POLLIN, .revents = 0});
    for (const auto& transport : transports_) transport->watch(descriptors);
    const Time pause = std::min<Time>(until - now, std::chrono::milliseconds{100});
    const timespec limit = to_timespec(pause);
    const int ready = ::ppoll(descriptors.data(), descriptors.size(), &limit, nullptr);
    if (ready < 0 || (also >= 0 && descriptors[0].revents != 0)) return;
  }
}

std::string LcmClient::where() const {
  std::string text;
  for (const auto& transport : transports_) {
    if (!text.empty()) text += " and ";
    text += transport->url();
  }
  return text;
}

}  // namespace takt
