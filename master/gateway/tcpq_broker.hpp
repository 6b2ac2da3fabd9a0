#pragma once
#include <cstdint>
#include <expected>
#include <memory>
#include <string>
#include <vector>

#include "master/gateway/channel_patterns.hpp"
#include "master/gateway/tcpq_connection.hpp"
#include "master/gateway/transport.hpp"

namespace takt {

/// LCM's tcpq:// server on loopback: programs that set `LCM_DEFAULT_URL=tcpq://127.0.0.1:7700`
/// exchange messages through it without a multicast route. What its owner publishes goes to the
/// clients, what clients publish goes to the owner and to the other clients.
class TcpqBroker final : public Transport {
 public:
  static constexpr std::size_t most_clients = 64;

  /// Port 0: any free one. An error is an errno; EADDRINUSE: there is a broker already.
  static std::expected<std::unique_ptr<TcpqBroker>, int> listen(std::uint16_t port);

  bool publish(const std::string& channel, std::span<const std::byte> data) override;
  bool wanted(std::string_view channel) const override;
  void subscribe(const std::string& pattern) override { own_.add(pattern); }
  void serve(const MessageHandler& handler) override;
  void watch(std::vector<pollfd>& descriptors) const override;
  bool good() const override { return true; }
  std::string url() const override;

  std::uint16_t port() const noexcept { return port_; }
  std::size_t clients() const noexcept { return clients_.size(); }

 private:
  struct Client {
    tcpq::Connection connection;
    ChannelPatterns patterns;
  };

  TcpqBroker(FileDescriptor listener, std::uint16_t port)
      : listener_{std::move(listener)}, port_{port} {}
  void accept_clients();
  void relay(const tcpq::Message& message);
  void take(Client& client, const tcpq::Message& message, const MessageHandler& handler);

  FileDescriptor listener_;
  std::uint16_t port_;
  std::vector<std::unique_ptr<Client>> clients_;
  ChannelPatterns own_;
};

}  // namespace takt
