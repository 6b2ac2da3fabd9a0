#include "master/gateway/tcpq_broker.hpp"

#include <algorithm>
#include <sys/socket.h>
#include <utility>

#include "master/gateway/tcp_loopback.hpp"

namespace takt {

std::expected<std::unique_ptr<TcpqBroker>, int> TcpqBroker::listen(std::uint16_t port) {
  auto listener = listen_on_loopback(port);
  if (!listener) return std::unexpected{listener.error()};
  return std::unique_ptr<TcpqBroker>{new TcpqBroker{std::move(listener->socket), listener->port}};
}

std::string TcpqBroker::url() const { return "tcpq://127.0.0.1:" + std::to_string(port_); }

bool TcpqBroker::publish(const std::string& channel, std::span<const std::byte> data) {
  relay({.type = tcpq::Type::publish, .channel = channel, .data = data});
  return true;
}

bool TcpqBroker::wanted(std::string_view channel) const {
  return std::ranges::any_of(clients_, [&](const auto& client) {
    return client->connection.opened() && client->patterns.match(channel);
  });
}

void TcpqBroker::relay(const tcpq::Message& message) {
  for (const auto& client : clients_) {
    if (!client->connection.opened() || !client->patterns.match(message.channel)) continue;
    client->connection.queue(message);
    client->connection.flush();
  }
}

void TcpqBroker::accept_clients() {
  for (;;) {
    FileDescriptor socket{
        ::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK)};
    if (!socket) return;
    if (clients_.size() == most_clients) continue;
    clients_.push_back(std::make_unique<Client>(
        Client{.connection = {std::move(socket), tcpq::magic_server, tcpq::magic_client},
               .patterns = {}}));
  }
}

void TcpqBroker::take(Client& client, const tcpq::Message& message, const MessageHandler& handler) {
  switch (message.type) {
    case tcpq::Type::subscribe:
      client.patterns.add(message.channel);
      return;
    case tcpq::Type::unsubscribe:
      client.patterns.remove(message.channel);
      return;
    case tcpq::Type::publish:
      relay(message);
      if (own_.match(message.channel)) handler(message.channel, message.data);
      return;
  }
}

void TcpqBroker::serve(const MessageHandler& handler) {
  accept_clients();
  for (const auto& client : clients_) {
    client->connection.flush();
    client->connection.receive(
        [&](const tcpq::Message& message) { take(*client, message, handler); });
  }
  std::erase_if(clients_, [](const auto& client) { return client->connection.closed(); });
}

void TcpqBroker::watch(std::vector<pollfd>& descriptors) const {
  descriptors.push_back({.fd = listener_.get(), .events = POLLIN, .revents = 0});
  for (const auto& client : clients_) {
    const int events = POLLIN | (client->connection.wants_to_write() ? POLLOUT : 0);
    descriptors.push_back(
        {.fd = client->connection.fd(), .events = static_cast<short>(events), .revents = 0});
  }
}

}  // namespace takt
