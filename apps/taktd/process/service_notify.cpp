#include "apps/taktd/process/service_notify.hpp"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "apps/taktd/process/environment.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt {
namespace {

std::int64_t environment_number(const char* name) {
  const std::string_view text = environment(name);
  std::int64_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

}  // namespace

ServiceNotify::ServiceNotify() : socket_{environment("NOTIFY_SOCKET")} {
  const std::int64_t pid = environment_number("WATCHDOG_PID");
  if (pid == 0 || pid == ::getpid()) {
    watchdog_ = std::chrono::microseconds{environment_number("WATCHDOG_USEC") / 2};
  }
}

void ServiceNotify::alive(Time now) {
  if (watchdog_ <= Time{0} || now - last_alive_ < watchdog_ / 2) return;
  last_alive_ = now;
  send("WATCHDOG=1");
}

void ServiceNotify::send(const std::string& text) const {
  sockaddr_un address{};
  if (socket_.empty() || socket_.size() >= sizeof address.sun_path) return;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, socket_.data(), socket_.size());
  if (address.sun_path[0] == '@') address.sun_path[0] = '\0';  // abstract name
  const FileDescriptor fd{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  if (!fd) return;
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
  ::sendto(fd.get(), text.data(), text.size(), MSG_NOSIGNAL,
           reinterpret_cast<const sockaddr*>(&address), size);
}

}  // namespace takt
