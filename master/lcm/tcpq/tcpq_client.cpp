#include "master/lcm/tcpq/tcpq_client.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <netinet/in.h>
#include <sys/socket.h>
#include <utility>

namespace takt {
namespace {

constexpr std::chrono::milliseconds reconnect_pause{500};

}  // namespace

TcpqClient::TcpqClient(std::string address, std::uint16_t port, FrontClock clock)
    : address_{std::move(address)}, port_{port}, clock_{std::move(clock)} {
  connect();
}

std::string TcpqClient::url() const { return "tcpq://" + address_ + ':' + std::to_string(port_); }

void TcpqClient::connect() {
  next_try_ = std::chrono::steady_clock::now() + reconnect_pause;
  connection_.reset();
  sockaddr_in server{};
  server.sin_family = AF_INET;
  server.sin_port = htons(port_);
  if (::inet_pton(AF_INET, address_.c_str(), &server.sin_addr) != 1) return;
  FileDescriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  if (!socket) return;
  const int result =
      ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&server), sizeof server);
  if (result != 0 && errno != EINPROGRESS) return;
  connection_.emplace(std::move(socket), tcpq::magic_client, tcpq::magic_server);
  for (const std::string& pattern : patterns_) {
    connection_->queue({.type = tcpq::Type::subscribe, .channel = pattern, .data = {}});
  }
}

bool TcpqClient::publish(const std::string& channel, std::span<const std::byte> data) {
  if (!connected()) return false;  // a message kept for later would arrive too late and look fresh
  const bool taken =
      connection_->queue({.type = tcpq::Type::publish, .channel = channel, .data = data});
  connection_->flush();
  return taken;
}

void TcpqClient::subscribe(const std::string& pattern) {
  patterns_.push_back(pattern);
  if (!connection_) return;
  connection_->queue({.type = tcpq::Type::subscribe, .channel = pattern, .data = {}});
  if (connected()) connection_->flush();
}

void TcpqClient::serve(const MessageHandler& handler) {
  if (!connection_) {
    if (std::chrono::steady_clock::now() >= next_try_) connect();
    return;
  }
  pollfd state{.fd = connection_->fd(), .events = POLLIN | POLLOUT, .revents = 0};
  if (::poll(&state, 1, 0) <= 0) return;
  if ((state.revents & POLLOUT) != 0) connection_->flush();
  const auto take = [&](const tcpq::Message& message) {
    if (message.type == tcpq::Type::publish) handler(message.channel, message.data);
  };
  connection_->receive(take, FrontBudget{clock_, FrontBudget::broker});
  if (connection_->closed()) {
    connection_.reset();
    next_try_ = std::chrono::steady_clock::now() + reconnect_pause;
  }
}

void TcpqClient::watch(std::vector<pollfd>& descriptors) const {
  if (!connection_) return;
  const int events = POLLIN | connection_->other_reason_to_wake();
  descriptors.push_back(
      {.fd = connection_->fd(), .events = static_cast<short>(events), .revents = 0});
}

bool tcpq_server_answers(const std::string& address, std::uint16_t port,
                         std::chrono::milliseconds limit) {
  TcpqClient client{address, port};
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!client.connected()) {
    std::vector<pollfd> descriptors;
    client.watch(descriptors);
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    if (descriptors.empty() || left.count() <= 0) return false;
    ::poll(descriptors.data(), descriptors.size(), static_cast<int>(left.count()));
    client.serve([](std::string_view, std::span<const std::byte>) {});
  }
  return true;
}

}  // namespace takt
