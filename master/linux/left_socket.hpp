#pragma once
#include <cerrno>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "master/linux/file_descriptor.hpp"

namespace takt {

/// Makes room for a listening socket at this address: removes a socket that a program has left
/// behind when it ended. Returns false if the name stays taken: a program listens there, the file
/// is not a socket, or it can't be removed.
inline bool remove_left_socket(const sockaddr_un& address) noexcept {
  struct stat found{};
  if (lstat(address.sun_path, &found) != 0) return errno == ENOENT;
  if (!S_ISSOCK(found.st_mode)) return false;
  const FileDescriptor probe{::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  const auto* target = reinterpret_cast<const sockaddr*>(&address);
  // A socket of another type that is in use answers EPROTOTYPE.
  if (!probe || ::connect(probe.get(), target, sizeof address) == 0) return false;
  return errno == ECONNREFUSED && ::unlink(address.sun_path) == 0;
}

}  // namespace takt
