#pragma once
#include <cstdint>
#include <cstring>
#include <optional>
#include <sys/socket.h>

#include "master/linux/clock.hpp"

namespace takt {

/// Room for the control messages of one received CAN frame.
inline constexpr std::size_t can_control_bytes =
    CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t));

/// The kernel's time stamp and its count of frames dropped since the socket was opened.
struct CanControl {
  Time realtime{};
  std::optional<std::uint32_t> dropped{};
};

inline CanControl can_control_of(msghdr& header) noexcept {
  CanControl control;
  for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
      control.realtime = std::chrono::seconds{stamp.tv_sec} + Time{stamp.tv_nsec};
    } else if (c->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t dropped = 0;
      std::memcpy(&dropped, CMSG_DATA(c), sizeof dropped);
      control.dropped = dropped;
    }
  }
  return control;
}

/// Converts a kernel time stamp to monotonic time. If a step of the wall clock has made the stamp
/// impossible, the result is `now`.
constexpr Time monotonic_stamp(Time realtime, Time offset, Time now) noexcept {
  constexpr Time oldest = std::chrono::seconds{1};
  const Time when = realtime - offset;
  return when > now || when < now - oldest ? now : when;
}

}  // namespace takt
