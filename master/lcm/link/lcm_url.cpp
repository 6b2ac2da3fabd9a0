#include "master/lcm/link/lcm_url.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <netinet/in.h>
#include <sys/socket.h>

#include "master/linux/file_descriptor.hpp"

namespace takt {

bool lcm_url_is_from_environment(const std::string& chosen, const std::string& configured) {
  const char* const environment = std::getenv("LCM_DEFAULT_URL");
  return chosen.empty() && configured.empty() && environment != nullptr && *environment != '\0';
}

std::string choose_lcm_url(const std::string& chosen, const std::string& configured) {
  if (!chosen.empty()) return chosen;
  if (!configured.empty()) return configured;
  if (lcm_url_is_from_environment(chosen, configured)) return std::getenv("LCM_DEFAULT_URL");
  return std::string{lcm_default_url};
}

std::string multicast_obstacle(const LcmUrl& url) {
  const FileDescriptor socket{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(url.port);
  if (!socket || ::inet_pton(AF_INET, url.address.c_str(), &group.sin_addr) != 1) return {};
  const auto* const address = reinterpret_cast<const sockaddr*>(&group);
  if (::connect(socket.get(), address, sizeof group) == 0) return {};
  if (errno != ENETUNREACH) return std::string{"multicast: "} + std::strerror(errno);
  return "this machine has no multicast route; `ip link set lo multicast on && ip route add "
         "224.0.0.0/4 dev lo` (as root) adds one";
}

}  // namespace takt
