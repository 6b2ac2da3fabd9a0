#include "apps/frame_text/frame_text.hpp"

#include <fmt/format.h>

#include "apps/frame_text/lss_text.hpp"
#include "apps/frame_text/value_text.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/emcy.hpp"
#include "master/wire/emcy_text.hpp"
#include "master/wire/nmt.hpp"

namespace takt {
namespace {

std::string_view command_text(NmtCommand command) {
  switch (command) {
    case NmtCommand::start:
      return "start";
    case NmtCommand::stop:
      return "stop";
    case NmtCommand::enter_preoperational:
      return "enter pre-operational";
    case NmtCommand::reset_node:
      return "reset";
    case NmtCommand::reset_communication:
      return "reset communication";
  }
  return "unknown";
}

std::string state_text(unsigned state) {
  switch (state) {
    case 0:
      return "boot-up";
    case 4:
      return "stopped";
    case 5:
      return "operational";
    case 127:
      return "pre-operational";
    default:
      return fmt::format("unknown state 0x{:02X}", state);
  }
}

std::uint64_t bits_of(const Frame& frame, const PdoField& field) {
  const auto all = load_le<std::uint64_t>(std::span{frame.data});
  const std::uint64_t mask = field.bits >= 64 ? ~0ULL : (1ULL << field.bits) - 1;
  return all >> field.bit_offset & mask;
}

/// TIME_OF_DAY: milliseconds since midnight (28 bits), days since 1984-01-01. CiA 301, 7.1.6.6.
std::string time_text(const Frame& frame) {
  const auto ms = load_le<std::uint32_t>(std::span{frame.data}) & 0x0FFF'FFFF;
  const auto days = load_le<std::uint16_t>(std::span{frame.data}.subspan(4));
  return fmt::format("day {} since 1984, {:02}:{:02}:{:02}.{:03}", days, ms / 3'600'000,
                     ms / 60'000 % 60, ms / 1000 % 60, ms % 1000);
}

}  // namespace

FrameMeaning FrameText::nmt(const Frame& frame) const {
  const auto message = decode_nmt(frame);
  if (!message) return {.service = "NMT", .text = "not a command: " + bytes_text(frame.payload())};
  const std::string who = message->node == 0 ? "all nodes" : names_.node(message->node);
  return {.service = "NMT",
          .node = message->node,
          .text = fmt::format("{} {}", command_text(message->command), who)};
}

FrameMeaning FrameText::error_control(const Frame& frame) const {
  const unsigned node = frame.id.id() & 0x7F;
  std::string text = names_.node(node);
  if (frame.rtr) return {.service = "GUARD", .node = node, .text = text + " asked for its state"};
  if (frame.length == 0) return {.service = "HEARTBEAT", .node = node, .text = text + " empty"};
  if (frame.data[0] == 0) return {.service = "BOOTUP", .node = node, .text = text};
  const unsigned state = frame.data[0] & 0x7F;
  const bool toggle = (frame.data[0] & 0x80) != 0;
  return {.service = "HEARTBEAT",
          .node = node,
          .text = fmt::format("{} {}{}", text, state_text(state), toggle ? " (toggle)" : "")};
}

FrameMeaning FrameText::emcy(const Frame& frame) const {
  const auto told = decode_emcy(frame);
  if (!told) return {.service = "EMCY"};
  const unsigned node = told->node.value();
  std::string text = fmt::format("{} {:04X} {}, error register {:02X} ({})", names_.node(node),
                                 told->code, emcy_text(told->code), told->error_register,
                                 error_register_text(told->error_register));
  const bool vendor = told->manufacturer != std::array<std::uint8_t, 5>{};
  if (vendor) text += ", vendor " + bytes_text(told->manufacturer);
  return {.service = "EMCY", .node = node, .text = std::move(text)};
}

FrameMeaning FrameText::pdo_of_row(const PdoRow& row, bool tpdo, const Frame& frame) const {
  const BusPlan& plan = *names_.plan();
  std::string text = fmt::format("{} {}", row.number, names_.node(row.node.value()));
  if (frame.rtr) {
    text += " asked for";
  } else if (frame.length < row.length) {
    text += fmt::format(": {} bytes, its mapping has {}", frame.length, row.length);
  } else {
    for (std::size_t i = 0; i < row.field_count; ++i) {
      const PdoField& field = plan.pdos.fields[row.first_field + i];
      const Signal& signal = plan.layout.signals[field.signal];
      text += fmt::format("  {}={}", signal.name, value_text(signal, bits_of(frame, field)));
    }
  }
  return {.service = tpdo ? "TPDO" : "RPDO", .node = row.node.value(), .text = std::move(text)};
}

std::optional<FrameMeaning> FrameText::pdo(const Frame& frame) const {
  if (names_.plan() == nullptr) return {};
  for (const PdoRow& row : names_.plan()->pdos.tpdos) {
    if (row.cob_id == frame.id) return pdo_of_row(row, true, frame);
  }
  for (const PdoRow& row : names_.plan()->pdos.rpdos) {
    if (row.cob_id == frame.id) return pdo_of_row(row, false, frame);
  }
  return {};
}

/// By the predefined connection set. CiA 301, 7.3.3.
FrameMeaning FrameText::predefined_pdo(const Frame& frame) const {
  const unsigned function = frame.id.id() >> 7;  // 3 TPDO1, 4 RPDO1, 5 TPDO2 ...
  const unsigned node = frame.id.id() & 0x7F;
  const bool tpdo = function % 2 == 1;
  return {.service = tpdo ? "TPDO" : "RPDO",
          .node = node,
          .text = fmt::format("{} {}", (function - 1) / 2, names_.node(node))};
}

FrameMeaning FrameText::meaning(const Frame& frame) {
  if (auto mapped = pdo(frame)) return std::move(*mapped);
  if (frame.id.is_extended()) return {};
  const BusPlan* plan = names_.plan();
  const CobId sync = plan == nullptr ? CobId::base(0x080) : plan->cycle.sync_cob_id;
  const std::uint32_t id = frame.id.id();
  const unsigned node = id & 0x7F;
  if (frame.id == sync) {
    return {.service = "SYNC", .text = frame.length == 0 ? "" : fmt::format("{}", frame.data[0])};
  }
  if (id == 0x000) return nmt(frame);
  if (id == 0x100) return {.service = "TIME", .text = time_text(frame)};
  if (id == 0x7E4 || id == 0x7E5) {
    return {.service = "LSS", .text = lss_text(frame, id == 0x7E5)};
  }
  if (node == 0) return {};
  switch (id & ~0x7FU) {
    case 0x080:
      return emcy(frame);
    case 0x580:
      return {.service = "SDO",
              .node = node,
              .text = names_.node(node) + " answers: " + sdo_.answer(node, frame)};
    case 0x600:
      return {.service = "SDO",
              .node = node,
              .text = names_.node(node) + " asked: " + sdo_.request(node, frame)};
    case 0x700:
      return error_control(frame);
    default:
      break;
  }
  if (id >= 0x180 && id < 0x580) return predefined_pdo(frame);
  return {};
}

}  // namespace takt
