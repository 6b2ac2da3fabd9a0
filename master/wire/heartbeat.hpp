#pragma once
#include <cstdint>
#include <optional>

#include "master/wire/frame.hpp"
#include "master/wire/nmt.hpp"

namespace takt {

/// Heartbeat, guarding answer or boot-up message on COB-ID 0x700 + node-ID. CiA 301, 7.2.8.3.2
/// and 7.2.8.3.3.
struct Heartbeat {
  NodeId node;
  NmtState state = NmtState::unknown;  ///< `bootup` marks the boot-up message
  bool toggle = false;                 ///< bit 7; only guarding answers use it
};

/// Returns the COB-ID of heartbeat, guarding and boot-up messages of a node.
constexpr CobId heartbeat_cob_id(NodeId node) noexcept {
  return CobId::base(0x700U + node.value());
}

/// Makes the remote frame that asks a node for its NMT state. CiA 301, 7.2.8.3.2.1.
constexpr Frame guarding_request(NodeId node) noexcept {
  return {.id = heartbeat_cob_id(node), .length = 1, .rtr = true};
}

constexpr Frame encode(const Heartbeat& heartbeat) noexcept {
  return make_frame(heartbeat_cob_id(heartbeat.node), {static_cast<std::uint8_t>(heartbeat.state)});
}

/// Decodes a heartbeat, guarding answer or boot-up message. Bit 7 is the toggle bit of guarding.
/// State codes that the standard does not define give `unknown`; they are signs of life
/// nevertheless. Returns std::nullopt if the frame is another one or has no state.
constexpr std::optional<Heartbeat> decode_heartbeat(const Frame& frame) noexcept {
  if (frame.id.is_extended() || frame.rtr || frame.length == 0) return {};
  if ((frame.id.id() & ~0x7FU) != 0x700) return {};
  const auto node = NodeId::from(frame.id.id() & 0x7F);
  if (!node) return {};
  const bool toggle = (frame.data[0] & 0x80) != 0;
  const auto state = static_cast<NmtState>(frame.data[0] & 0x7F);
  switch (state) {
    case NmtState::bootup:
    case NmtState::stopped:
    case NmtState::operational:
    case NmtState::preoperational:
      return Heartbeat{*node, state, toggle};
    case NmtState::unknown:
      break;
  }
  return Heartbeat{*node, NmtState::unknown, toggle};
}

}  // namespace takt
