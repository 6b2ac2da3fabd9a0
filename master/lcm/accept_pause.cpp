#include "master/lcm/accept_pause.hpp"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <sys/socket.h>

namespace takt {

std::expected<FileDescriptor, std::string> AcceptPause::accept(int listener, Time now) {
  FileDescriptor socket{::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK)};
  if (socket) return socket;
  const int error = errno;
  const bool missing = error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM;
  if (!missing) return std::unexpected{std::string{}};
  until_ = now + length;
  if (!reported_.allow("accept", now)) return std::unexpected{std::string{}};
  return std::unexpected{fmt::format(
      "new connections wait: {}{}", std::strerror(error),
      error == EMFILE ? "; end some programs, or raise the limit (ulimit -n, LimitNOFILE=)" : "")};
}

}  // namespace takt
