#include "master/lcm/tcpq/tcpq_broker.hpp"

#include <algorithm>
#include <sys/socket.h>
#include <utility>

#include "master/lcm/printable_text.hpp"
#include "master/linux/tcp_loopback.hpp"

namespace takt {
namespace {

constexpr int most_accepts = 16;  // connections accepted in one round

}  // namespace

std::expected<std::unique_ptr<TcpqBroker>, int> TcpqBroker::listen(std::uint16_t port,
                                                                   Options options) {
  auto listener = listen_on_loopback(port);
  if (!listener) return std::unexpected{listener.error()};
  return std::unique_ptr<TcpqBroker>{
      new TcpqBroker{std::move(listener->socket), listener->port, std::move(options)}};
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

void TcpqBroker::subscribe(const std::string& pattern) {
  if (const auto added = own_.add(pattern); !added) {
    options_.say("LCM hub: taktd can't subscribe to '" + pattern + "': " + added.error());
  }
}

void TcpqBroker::relay(const tcpq::Message& message) {
  for (const auto& client : clients_) {
    const bool usable = client->connection.opened() && !client->connection.closed();
    if (!usable || !client->patterns.match(message.channel)) continue;
    client->connection.queue(message);
    client->connection.flush();
  }
}

void TcpqBroker::close(Client& client, const std::string& why) {
  client.connection.close();
  const auto kept_back = reported_.allow(why.substr(0, 40), options_.clock());
  if (kept_back) {
    options_.say(with_kept_back("LCM hub: a connection was closed: " + why, *kept_back));
  }
}

void TcpqBroker::accept_clients(Time now) {
  for (int i = 0; i < most_accepts && !accept_pause_.active(now); ++i) {
    auto socket = accept_pause_.accept(listener_.get(), now);
    if (!socket && !socket.error().empty()) options_.warn("LCM hub: " + socket.error());
    if (!socket) return;
    if (clients_.size() == most_clients && !make_room(now)) continue;
    clients_.push_back(std::make_unique<Client>(
        Client{.connection = {std::move(*socket), tcpq::magic_server, tcpq::magic_client},
               .since = now,
               .heard = now,
               .read = now}));
  }
}

/// Closes a connection to make room for a new one. The first choice is the oldest connection whose
/// handshake is incomplete, the second choice the oldest one that has neither subscribed nor
/// published. Otherwise it is the connection that has sent nothing for the longest time, at most
/// one per second. LCM's clients reconnect, so each of them is served at some time. A program that
/// sends commands is never idle long enough to be closed.
bool TcpqBroker::make_room(Time now) {
  const std::string full = "the hub has " + std::to_string(most_clients) + " connections already";
  auto unasked = std::ranges::find_if(
      clients_, [](const auto& client) { return !client->connection.opened(); });
  if (unasked == clients_.end()) unasked = std::ranges::find(clients_, false, &Client::has_asked);
  if (unasked != clients_.end()) {
    close(**unasked,
          full +
              ", and the connection that was closed had neither subscribed nor published anything");
  } else if (Client* const idle = idle_client(now)) {
    displaced_ = now;
    close(*idle, full + ", and the connection that was closed had sent nothing for 10 s");
  } else {
    if (reported_.allow(full, options_.clock())) {
      options_.say("LCM hub: a new connection was refused: " + full);
    }
    return false;
  }
  remove_closed();
  return true;
}

/// Returns the connection whose last message is the oldest. Returns nullptr if all connections are
/// active, or if an idle one was closed less than displacing_pause ago.
TcpqBroker::Client* TcpqBroker::idle_client(Time now) {
  if (now - displaced_ < displacing_pause) return nullptr;
  const auto idle =
      std::ranges::min_element(clients_, {}, [](const auto& client) { return client->heard; });
  return now - (*idle)->heard < idle_limit ? nullptr : idle->get();
}

void TcpqBroker::close_unopened(Time now) {
  for (const auto& client : clients_) {
    if (client->connection.opened() || now - client->since < opening_limit) continue;
    close(*client, "its handshake was incomplete after 2 s");
  }
}

/// Closes connections that do not read. Otherwise their unsent messages, up to a megabyte each,
/// would be kept for ever.
void TcpqBroker::close_unread(Time now) {
  for (const auto& client : clients_) {
    const bool reads =
        !client->connection.wants_to_write() ||
        std::exchange(client->taken, client->connection.taken()) != client->connection.taken();
    if (reads) client->read = now;
    if (now - client->read >= reading_limit) close(*client, "it has read nothing for 10 s");
  }
}

void TcpqBroker::add_pattern(Client& client, std::string_view pattern) {
  std::size_t characters = pattern.size();
  for (const auto& one : clients_) characters += one->patterns.characters();
  if (characters > most_characters) {
    return close(client, "the patterns of all connections together have more than " +
                             std::to_string(most_characters) + " characters");
  }
  const auto added = client.patterns.add(pattern);
  if (!added) {
    close(client, "its pattern '" + printable_text(pattern.substr(0, 40)) +
                      "' is refused: " + added.error());
  }
}

void TcpqBroker::take(Client& client, const tcpq::Message& message, Time now,
                      const MessageHandler& handler) {
  client.has_asked = true;
  client.heard = now;
  switch (message.type) {
    case tcpq::Type::subscribe:
      add_pattern(client, message.channel);
      return;
    case tcpq::Type::unsubscribe:
      client.patterns.remove(message.channel);
      return;
    case tcpq::Type::publish:
      if (message.channel.size() > longest_name) {
        return close(client, "it published on a channel whose name has more than 63 characters");
      }
      relay(message);
      if (own_.match(message.channel)) handler(message.channel, message.data);
      return;
  }
}

/// If the budget ends before all clients are served, the next round begins with the next client.
void TcpqBroker::receive(Time now, const MessageHandler& handler) {
  const FrontBudget budget{options_.clock, FrontBudget::broker};
  const std::size_t count = clients_.size();
  if (turn_ >= count) turn_ = 0;
  const std::size_t first = turn_;
  drained_ = false;
  for (std::size_t i = 0; i < count; ++i) {
    Client& client = *clients_[(first + i) % count];
    client.connection.flush();
    client.connection.receive(
        [&](const tcpq::Message& message) { take(client, message, now, handler); }, budget);
    turn_ = (first + i + 1) % count;
    if (!budget.is_left()) return;
  }
  drained_ = std::ranges::all_of(clients_,
                                 [](const auto& client) { return client->connection.drained(); });
}

void TcpqBroker::remove_closed() {
  std::erase_if(clients_, [](const auto& client) { return client->connection.closed(); });
}

void TcpqBroker::serve(const MessageHandler& handler) {
  const Time now = options_.clock();
  accept_clients(now);
  receive(now, handler);
  close_unopened(now);
  close_unread(now);
  remove_closed();
}

void TcpqBroker::watch(std::vector<pollfd>& descriptors) const {
  if (!accept_pause_.active(options_.clock())) {
    descriptors.push_back({.fd = listener_.get(), .events = POLLIN, .revents = 0});
  }
  for (const auto& client : clients_) {
    const int events = POLLIN | client->connection.other_reason_to_wake();
    descriptors.push_back(
        {.fd = client->connection.fd(), .events = static_cast<short>(events), .revents = 0});
  }
}

}  // namespace takt
