#pragma once
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <string>
#include <takt/lcm.hpp>
#include <vector>

#include "master/lcm/accept_pause.hpp"
#include "master/lcm/channel_patterns.hpp"
#include "master/lcm/front_budget.hpp"
#include "master/lcm/rate_limit.hpp"
#include "master/lcm/tcpq/tcpq_connection.hpp"
#include "master/linux/clock.hpp"

namespace takt {

/// A server of LCM's tcpq:// protocol on loopback. Programs that set
/// `LCM_DEFAULT_URL=tcpq://127.0.0.1:7700` exchange messages through it without a multicast route.
/// Messages of its owner go to the clients, and messages of a client go to the owner and to the
/// other clients. Connections, patterns, bytes and the time of each serve() are bounded.
class TcpqBroker final : public Transport {
 public:
  static constexpr std::size_t most_clients = 64;
  /// Greatest total length of the patterns of all connections.
  static constexpr std::size_t most_characters = 32768;
  static constexpr std::size_t longest_name = 63;  ///< longest channel name, as in LCM
  static constexpr Time opening_limit = std::chrono::seconds{2};
  /// A client that reads nothing for this time is closed.
  static constexpr Time reading_limit = std::chrono::seconds{10};
  /// If all places are taken, a connection that has sent nothing for this time may be closed for a
  /// new one.
  static constexpr Time idle_limit = std::chrono::seconds{10};
  static constexpr Time displacing_pause = std::chrono::seconds{1};

  struct Options {
    FrontClock clock = monotonic_now;
    /// Receives the reason for closing a connection, at most once in 10 s for the same reason.
    std::function<void(const std::string& sentence)> say = [](const std::string&) {};
    /// Receives a sentence about a problem that the user should correct, at most once in 10 s.
    std::function<void(const std::string& sentence)> warn = [](const std::string&) {};
  };

  /// Port 0 selects any free port. The error is an errno; EADDRINUSE means that the port is taken.
  static std::expected<std::unique_ptr<TcpqBroker>, int> listen(std::uint16_t port,
                                                                Options options = defaults());

  bool publish(const std::string& channel, std::span<const std::byte> data) override;
  bool wanted(std::string_view channel) const override;
  void subscribe(const std::string& pattern) override;
  void serve(const MessageHandler& handler) override;
  bool drained() const override { return drained_; }
  void watch(std::vector<pollfd>& descriptors) const override;
  bool good() const override { return true; }
  std::string url() const override;

  std::uint16_t port() const noexcept { return port_; }
  std::size_t clients() const noexcept { return clients_.size(); }

 private:
  struct Client {
    tcpq::Connection connection;
    ChannelPatterns patterns{};
    Time since{};            // time of the connection
    Time heard{};            // time of the newest message of the client
    Time read{};             // last time at which the client read, or had nothing to read
    std::uint64_t taken{};   // number of bytes that the kernel had taken at that time
    bool has_asked = false;  // the client has subscribed or published
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
  std::size_t turn_ = 0;                          // index of the client served first
  // Time at which a connection that had subscribed or published was last closed for a new one.
  Time displaced_ = -displacing_pause;
  bool drained_ = true;  // the newest round has read everything from all clients
  ChannelPatterns own_;
  RateLimit reported_{std::chrono::seconds{10}};
  AcceptPause accept_pause_;
};

}  // namespace takt
