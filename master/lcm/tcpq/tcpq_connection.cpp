#include "master/lcm/tcpq/tcpq_connection.hpp"

#include <array>
#include <cerrno>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <utility>

#include "master/linux/tcp_loopback.hpp"

namespace takt::tcpq {
namespace {

void set_option(int fd, int level, int option, int value) noexcept {
  ::setsockopt(fd, level, option, &value, sizeof value);
}

}  // namespace

Connection::Connection(FileDescriptor socket, std::uint32_t own_magic, std::uint32_t other_magic)
    : socket_{std::move(socket)}, parser_{other_magic} {
  set_option(fd(), IPPROTO_TCP, TCP_NODELAY, 1);
  // The buffer is small, so that a reader that continues after a stop finds seconds, not minutes,
  // of old messages.
  set_option(fd(), SOL_SOCKET, SO_SNDBUF, 128 * 1024);
  append_opening(unsent_, own_magic);
}

bool Connection::queue(const Message& message) {
  const std::size_t size = message.data.size() + message.channel.size() + 12;
  if (unsent_.size() - sent_ + size > unsent_limit) return false;
  append(unsent_, message);
  return true;
}

void Connection::flush() noexcept {
  while (!closed_ && wants_to_write()) {
    const ssize_t taken =
        ::send(fd(), unsent_.data() + sent_, unsent_.size() - sent_, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (taken < 0) {
      closed_ = !would_wait(errno);
      break;
    }
    sent_ += static_cast<std::size_t>(taken);
    taken_ += static_cast<std::uint64_t>(taken);
  }
  if (sent_ == unsent_.size()) {
    unsent_.clear();
    sent_ = 0;
  } else if (sent_ > unsent_limit / 2) {
    unsent_.erase(unsent_.begin(), unsent_.begin() + static_cast<std::ptrdiff_t>(sent_));
    sent_ = 0;
  }
}

void Connection::receive(const std::function<void(const Message&)>& handler,
                         const FrontBudget& budget) {
  std::array<std::byte, 16384> chunk;
  drained_ = false;
  // LCM's client sends a message in five small pieces without TCP_NODELAY. Each piece must be
  // acknowledged at once, or a command takes 40 ms. The kernel resets this option by itself.
  set_option(fd(), IPPROTO_TCP, TCP_QUICKACK, 1);
  while (hand_over(handler, budget)) {
    const ssize_t size = ::recv(fd(), chunk.data(), chunk.size(), MSG_DONTWAIT);
    if (size <= 0) {
      closed_ = size == 0 || !would_wait(errno);
      drained_ = true;
      return;
    }
    parser_.feed(std::span{chunk}.first(static_cast<std::size_t>(size)));
    if (!hand_over(handler, budget) || !budget.is_left()) return;
  }
}

/// Returns false if the budget ended before the messages did, or if the connection is closed.
bool Connection::hand_over(const std::function<void(const Message&)>& handler,
                           const FrontBudget& budget) {
  unhandled_ = false;
  while (const auto message = parser_.next()) {
    handler(*message);
    if (closed_) return false;
    if (!budget.is_left()) {
      unhandled_ = true;
      return false;
    }
  }
  closed_ = closed_ || parser_.broken();
  return !closed_;
}

}  // namespace takt::tcpq
