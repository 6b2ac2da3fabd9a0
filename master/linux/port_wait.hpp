#pragma once
#include <algorithm>
#include <poll.h>

#include "master/linux/clock.hpp"

namespace takt {

/// Waits for a frame on `fd` with one system call. Returns true if there is one.
inline bool wait_for_frame(int fd, Time until) noexcept {
  pollfd wanted{.fd = fd, .events = POLLIN, .revents = 0};
  const timespec timeout = to_timespec(std::max(Time{0}, until - monotonic_now()));
  return ::ppoll(&wanted, 1, &timeout, nullptr) > 0;
}

/// Replaces wait_for_frame() while the interface is down. Returns true if receive() should look for
/// the interface again.
inline bool wait_to_look_again(Time look_again, Time until) noexcept {
  const Time pause = std::min(until, monotonic_now() + look_again);
  sleep_until(pause);
  return pause < until;
}

}  // namespace takt
