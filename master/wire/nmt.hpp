#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/table/boot_plan.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// NMT state as a heartbeat codes it. CiA 301, table 107. `unknown` means that no sign of life has
/// come yet.
enum class NmtState : std::uint8_t {
  bootup = 0,
  stopped = 4,
  operational = 5,
  preoperational = 127,
  unknown = 255,
};

/// NMT node control message. CiA 301, 7.2.8.2.1.
struct NmtMessage {
  NmtCommand command = NmtCommand::start;
  std::uint8_t node = 0;  ///< node-ID, 0 means all nodes
  constexpr bool operator==(const NmtMessage&) const noexcept = default;
};

/// COB-ID of NMT commands.
inline constexpr CobId nmt_cob_id = CobId::base(0x000);

/// Returns true if the command resets the node or its communication.
constexpr bool is_reset(NmtCommand command) noexcept {
  return command == NmtCommand::reset_node || command == NmtCommand::reset_communication;
}

constexpr Frame encode(const NmtMessage& message) noexcept {
  return make_frame(nmt_cob_id, {static_cast<std::uint8_t>(message.command), message.node});
}

/// Decodes an NMT command. Returns std::nullopt if the frame is no NMT command, or is one that
/// every node ignores (unknown command specifier, node-ID above 127).
constexpr std::optional<NmtMessage> decode_nmt(const Frame& frame) noexcept {
  if (frame.id != nmt_cob_id || frame.rtr || frame.length != 2 || frame.data[1] > 127) return {};
  const auto command = static_cast<NmtCommand>(frame.data[0]);
  switch (command) {
    case NmtCommand::start:
    case NmtCommand::stop:
    case NmtCommand::enter_preoperational:
    case NmtCommand::reset_node:
    case NmtCommand::reset_communication:
      return NmtMessage{command, frame.data[1]};
  }
  return {};
}

}  // namespace takt
