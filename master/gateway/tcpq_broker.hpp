#pragma once
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "master/gateway/channel_patterns.hpp"
#include "master/gateway/rate_limit.hpp"
#include "master/gateway/tcpq_connection.hpp"
#include "master/gateway/time_budget.hpp"
#include "master/gateway/transport.hpp"
#include "master/linux/clock.hpp"

namespace takt {

/// LCM's tcpq:// server on loopback: programs that set `LCM_DEFAULT_URL=tcpq://127.0.0.1:7700`
/// exchange messages through it without a multicast route. What its owner publishes goes to the
/// clients, what clients publish goes to the owner and to the other clients. Connections, patterns,
/// bytes and the time of each serve() are bounded.
class TcpqBroker final : public Transport {
 public:
  static constexpr std::size_t most_clients = 64;
  static constexpr std::size_t most_characters = 32768;  ///< of the patterns of all connections
  static constexpr std::size_t longest_name = 63;        ///< of a channel, as LCM's own
  static constexpr Time opening_limit = std::chrono::seconds{2};
  static constexpr Time reading_limit = std::chrono::seconds{10};  ///< without reading anything
  /// Where there is no place left, a connection that has sent nothing for so long gives way.
  static constexpr Time idle_limit = std::chrono::seconds{10};
  static constexpr Time displacing_pause = std::chrono::seconds{1};

  struct Options {
    FrontClock clock = monotonic_now;
    /// Hears why a connection is closed, at most once in 10 s for the same reason.
    std::function<void(const std::string& sentence)> say = [](const std::string&) {};
  };

  /// Port 0: any free one. An error is an errno; EADDRINUSE: there is a broker already.
  static std::expected<std::unique_ptr<TcpqBroker>, int> listen(std::uint16_t port,
                                                                Options options = defaults());

  bool publish(const std::string& channel, std::span<const std::byte> data) override;
  bool wanted(std::string_view channel) const override;
  void subscribe(const std::string& pattern) override;
  void serve(const MessageHandler& handler) override;
  void watch(std::vector<pollfd>& descriptors) const override;
  bool good() const override { return true; }
  std::string url() const override;

  std::uint16_t port() const noexcept { return port_; }
  std::size_t clients() const noexcept { return clients_.size(); }

 private:
  struct Client {
    tcpq::Connection connection;
    ChannelPatterns patterns{};
    Time since{};            // when it connected
    Time heard{};            // when it sent a message
    Time read{};             // when it read, or there was nothing to read
    std::uint64_t taken{};   // by then
    bool has_asked = false;  // it has subscribed or published
  };

  static Options defaults() { return {}; }
  TcpqBroker(FileDescriptor listener, std::uint16_t port, Options options)
      : listener_{std::move(listener)}, port_{port}, options_{std::move(options)} {}
  void accept_clients(Time now);
  bool make_room(Time now);
  Client* idle_client(Time now);
  void close_unopened(Time now);
  void close_unread(Time now);
  void receive(Time now, const MessageHandler& handler);
  void relay(const tcpq::Message& message);
  void take(Client& client, const tcpq::Message& message, Time now, const MessageHandler& handler);
  void add_pattern(Client& client, std::string_view pattern);
  void close(Client& client, const std::string& why);
  void remove_closed();

  FileDescriptor listener_;
  std::uint16_t port_;
  Options options_;
  std::vector<std::unique_ptr<Client>> clients_;  // oldest first
  std::size_t turn_ = 0;                          // of the client that is served first
  Time displaced_ = -displacing_pause;            // when a connection last gave way that had asked
  ChannelPatterns own_;
  RateLimit told_{std::chrono::seconds{10}};
};

}  // namespace takt
