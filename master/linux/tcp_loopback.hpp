#pragma once
#include <cerrno>
#include <cstdint>
#include <expected>
#include <netinet/in.h>
#include <sys/socket.h>

#include "master/linux/file_descriptor.hpp"

namespace takt {

/// A listening socket for programs of this machine. Its accept() does not wait.
struct LoopbackListener {
  FileDescriptor socket;
  std::uint16_t port = 0;
};

/// Listens on loopback; port 0 selects any free port. The error is an errno.
inline std::expected<LoopbackListener, int> listen_on_loopback(std::uint16_t port) noexcept {
  LoopbackListener listener{
      .socket = FileDescriptor{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)}};
  const int fd = listener.socket.get();
  if (fd < 0) return std::unexpected{errno};
  const int on = 1;
  ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (::bind(fd, generic, size) != 0 || ::listen(fd, 16) != 0 ||
      ::getsockname(fd, generic, &size) != 0) {
    return std::unexpected{errno};
  }
  listener.port = ntohs(address.sin_port);
  return listener;
}

/// Returns true if a call failed with `error` only because it would have had to wait.
constexpr bool would_wait(int error) noexcept {
  return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

}  // namespace takt
