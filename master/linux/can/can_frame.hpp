#pragma once
#include <algorithm>
#include <cstring>
#include <linux/can.h>

#include "master/wire/frame.hpp"

namespace takt {

/// Returns the identifier in SocketCAN format, with its EFF and RTR flags.
constexpr canid_t kernel_id(const Frame& frame) noexcept {
  return frame.id.id() | (frame.id.is_extended() ? CAN_EFF_FLAG : 0U) |
         (frame.rtr ? CAN_RTR_FLAG : 0U);
}

inline can_frame to_kernel(const Frame& frame) noexcept {
  can_frame out{};
  out.can_id = kernel_id(frame);
  out.can_dlc = std::min<std::uint8_t>(frame.length, CAN_MAX_DLEN);
  std::memcpy(out.data, frame.data.data(), CAN_MAX_DLEN);
  return out;
}

inline Frame from_kernel(canid_t id, std::uint8_t length, const std::uint8_t* data) noexcept {
  Frame out{.id = (id & CAN_EFF_FLAG) != 0 ? CobId::extended(id) : CobId::base(id)};
  out.length = std::min<std::uint8_t>(length, CAN_MAX_DLEN);
  out.rtr = (id & CAN_RTR_FLAG) != 0;
  if (!out.rtr) std::memcpy(out.data.data(), data, out.length);
  return out;
}

}  // namespace takt
