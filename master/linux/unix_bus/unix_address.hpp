#pragma once
#include <cstring>
#include <optional>
#include <string>
#include <sys/socket.h>
#include <sys/un.h>

#include "master/linux/file_descriptor.hpp"

namespace takt {

/// Returns the address of a path, or std::nullopt if the path is empty or too long for the kernel
/// (107 bytes).
inline std::optional<sockaddr_un> unix_address(const std::string& path) noexcept {
  sockaddr_un address{};
  if (path.empty() || path.size() >= sizeof address.sun_path) return std::nullopt;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

/// Returns a connected, non-blocking SEQPACKET socket, or an empty descriptor with the reason in
/// errno.
inline FileDescriptor connect_unix(const sockaddr_un& address) noexcept {
  FileDescriptor socket{::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  const auto* target = reinterpret_cast<const sockaddr*>(&address);
  if (!socket || connect(socket.get(), target, sizeof address) != 0) return {};
  return socket;
}

}  // namespace takt
