#pragma once
#include <cstring>
#include <optional>
#include <string>
#include <sys/un.h>

namespace takt {

/// The address of a path; none where it is empty or too long for the kernel (107 bytes).
inline std::optional<sockaddr_un> unix_address(const std::string& path) noexcept {
  sockaddr_un address{};
  if (path.empty() || path.size() >= sizeof address.sun_path) return std::nullopt;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

}  // namespace takt
