#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <takt/lcm.hpp>
#include <vector>

#include "master/lcm/channel_patterns.hpp"
#include "master/lcm/front_budget.hpp"
#include "master/lcm/tcpq/tcpq_connection.hpp"
#include "master/linux/clock.hpp"

namespace takt {

/// A client of LCM's tcpq:// protocol. Unlike LCM's own client, it never waits for the server and
/// reconnects by itself when the server comes back.
class TcpqClient final : public Transport {
 public:
  TcpqClient(std::string address, std::uint16_t port, FrontClock clock = monotonic_now);

  /// Returns true once the server has answered.
  bool connected() const noexcept { return connection_ && connection_->opened(); }

  bool publish(const std::string& channel, std::span<const std::byte> data) override;
  void subscribe(const std::string& pattern) override;
  void serve(const MessageHandler& handler) override;
  bool drained() const override { return !connection_ || connection_->drained(); }
  void watch(std::vector<pollfd>& descriptors) const override;
  bool good() const override { return true; }
  std::string url() const override;

 private:
  void connect();

  std::string address_;  // dotted IPv4
  std::uint16_t port_;
  std::vector<std::string> patterns_;
  std::optional<tcpq::Connection> connection_;
  std::chrono::steady_clock::time_point next_try_{};
  FrontClock clock_;
};

/// A hub on this machine answers within this time.
inline constexpr std::chrono::milliseconds hub_answer_limit{200};

/// Returns true if a server of the tcpq:// protocol answers at this address. Waits at most `limit`.
bool tcpq_server_answers(const std::string& address, std::uint16_t port,
                         std::chrono::milliseconds limit);

}  // namespace takt
