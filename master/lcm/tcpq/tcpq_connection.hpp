#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <poll.h>
#include <vector>

#include "master/lcm/front_budget.hpp"
#include "master/lcm/tcpq/tcpq_parser.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt::tcpq {

/// One TCP connection with bounded buffers. No call waits.
class Connection {
 public:
  /// Largest number of unsent bytes. A message that does not fit is lost as a whole.
  static constexpr std::size_t unsent_limit = 1 << 20;

  Connection(FileDescriptor socket, std::uint32_t own_magic, std::uint32_t other_magic);

  int fd() const noexcept { return socket_.get(); }
  bool closed() const noexcept { return closed_; }
  bool opened() const noexcept { return parser_.opened(); }
  bool wants_to_write() const noexcept { return sent_ < unsent_.size(); }
  /// Returns the number of bytes that the kernel has accepted for sending since the start.
  std::uint64_t taken() const noexcept { return taken_; }

  /// Returns false if there is no room; the message is lost.
  bool queue(const Message& message);
  /// Sends as much as the kernel takes.
  void flush() noexcept;
  /// Reads and hands over messages until nothing is left or the budget is used up. Each call makes
  /// progress, however small the budget is.
  void receive(const std::function<void(const Message&)>& handler, const FrontBudget& budget);
  /// Returns true if the last receive() has read all bytes that had arrived.
  bool drained() const noexcept { return drained_; }
  /// Returns the events for poll() in addition to POLLIN. If received messages wait in this object
  /// for the next round, the result is POLLOUT: nearly every socket is writable, so poll() then
  /// returns at once.
  short other_reason_to_wake() const noexcept {
    return wants_to_write() || unhandled_ ? POLLOUT : 0;
  }
  void close() noexcept { closed_ = true; }

 private:
  bool hand_over(const std::function<void(const Message&)>& handler, const FrontBudget& budget);

  FileDescriptor socket_;
  Parser parser_;
  std::vector<std::byte> unsent_;
  std::size_t sent_ = 0;  // bytes of unsent_ already sent
  std::uint64_t taken_ = 0;
  bool unhandled_ = false;
  bool drained_ = true;
  bool closed_ = false;
};

}  // namespace takt::tcpq
