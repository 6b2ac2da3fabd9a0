#include <fmt/format.h>

#include "master/explain/frame/frame_value_text.hpp"
#include "master/explain/frame/service_texts.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/parameter_channel.hpp"

namespace takt {
namespace {

constexpr std::uint8_t destination_flag = 0x80;  // bit 7 of the first byte of a DAM-MPDO

/// A PDO of the plan and its direction, from the device's view.
struct Found {
  const PdoRow* row = nullptr;
  bool tpdo = false;
};

std::uint64_t bits_of(const Frame& frame, const PdoField& field) {
  const auto all = load_le<std::uint64_t>(std::span{frame.data});
  const std::uint64_t mask = field.bits >= 64 ? ~0ULL : (1ULL << field.bits) - 1;
  return all >> field.bit_offset & mask;
}

/// Returns true if the row describes the object that this MPDO carries. Also returns true for every
/// PDO that is no MPDO. A DAM frame to all nodes also addresses the node of the row.
bool is_of(const PdoRow& row, const Frame& frame) {
  if (!row.multiplexed() || frame.rtr) return true;
  const auto header = load_le<std::uint32_t>(std::span{frame.data});
  const bool to_all = (header & 0xFF) == destination_flag;
  return header == row.header || (to_all && header >> 8 == row.header >> 8);
}

Found find(const std::vector<PdoRow>& rows, bool tpdo, const Frame& frame) {
  Found found;
  for (const PdoRow& row : rows) {
    if (row.cob_id != frame.id) continue;
    if (is_of(row, frame)) return {&row, tpdo};
    if (found.row == nullptr) found = {&row, tpdo};  // This MPDO may carry another object.
  }
  return found;
}

std::string fields_text(const BusPlan& plan, const PdoRow& row, const Frame& frame) {
  std::string text;
  for (const PdoField& field : plan.pdos.fields_of(row)) {
    const Signal& signal = plan.layout.signals[field.signal];
    text += fmt::format("  {}={}", signal.name, value_text(signal, bits_of(frame, field)));
  }
  return text;
}

/// Describes an MPDO, beginning with `DAM to shoulder` or `SAM from shoulder`.
std::string mpdo_text(const FrameNames& names, const PdoRow& row, const Frame& frame) {
  const std::uint8_t first = frame.data[0];
  const unsigned address = first & 0x7FU;
  const std::string who = address == 0 ? "all nodes" : names.node(address);
  std::string text =
      fmt::format(" MPDO {} {}", (first & destination_flag) != 0 ? "DAM to" : "SAM from", who);
  if (is_of(row, frame)) return text + fields_text(*names.plan(), row, frame);
  const ObjectKey object{load_le<std::uint16_t>(std::span{frame.data}.subspan(1)), frame.data[3]};
  return text + fmt::format("  {} = {} (not in the plan)", names.object(address, object),
                            bytes_text(std::span{frame.data}.subspan(4)));
}

/// Describes a request or an answer of a frequency converter whose PDO 1 carries parameters.
std::string channel_text(bool tpdo, const Frame& frame) {
  const std::span bytes{frame.data};
  const unsigned word = load_le<std::uint16_t>(bytes);
  const unsigned second = load_le<std::uint16_t>(bytes.subspan(2));
  const auto value = load_le<std::uint32_t>(bytes.subspan(4));
  if (!tpdo && word == 1) return fmt::format(": read parameter 0x{:04X}", second);
  if (!tpdo && word == 2) return fmt::format(": write parameter 0x{:04X} = {}", second, value);
  const auto answer = parameter_channel::answer(frame.payload());
  if (!tpdo || !answer)
    return ": not a parameter request or answer, " + bytes_text(frame.payload());
  if (answer->done) return fmt::format(": done, value {}", answer->value);
  return fmt::format(": refused, {} ({})", parameter_channel::error_text(answer->error),
                     answer->error);
}

std::string content_text(const FrameNames& names, const Found& found, const Frame& frame) {
  const BusPlan& plan = *names.plan();
  const PdoRow& row = *found.row;
  if (frame.length < row.length) {
    return fmt::format(": {} bytes, but the mapping has {}", frame.length, row.length);
  }
  std::string text;
  if (row.multiplexed()) {
    text = mpdo_text(names, row, frame);
  } else if (row.on_request) {
    const bool channel = frame.length == 8 && row.node_index < plan.nodes.size() &&
                         !plan.nodes[row.node_index].device_data.empty();
    text = channel ? channel_text(found.tpdo, frame) : ": " + bytes_text(frame.payload());
  } else {
    text = fields_text(plan, row, frame);
  }
  if (frame.length > row.length) {
    text += fmt::format("  ({} bytes, but the mapping has {})", frame.length, row.length);
  }
  return text;
}

}  // namespace

std::optional<FrameMeaning> planned_pdo(const FrameNames& names, const Frame& frame) {
  if (names.plan() == nullptr) return {};
  Found found = find(names.plan()->pdos.tpdos, true, frame);
  if (found.row == nullptr) found = find(names.plan()->pdos.rpdos, false, frame);
  if (found.row == nullptr) return {};
  const unsigned node = found.row->node.value();
  return FrameMeaning{
      .service = found.tpdo ? "TPDO" : "RPDO",
      .node = node,
      .text = fmt::format("{} {}{}", found.row->number, names.node(node),
                          frame.rtr ? " remote request" : content_text(names, found, frame))};
}

FrameMeaning predefined_pdo(const FrameNames& names, const Frame& frame) {
  const unsigned function = frame.id.id() >> 7;  // 3 TPDO1, 4 RPDO1, 5 TPDO2 ...
  const unsigned node = frame.id.id() & 0x7F;
  return {.service = function % 2 == 1 ? "TPDO" : "RPDO",
          .node = node,
          .text = fmt::format("{} {}{}", (function - 1) / 2, names.node(node),
                              frame.rtr ? " remote request" : "")};
}

}  // namespace takt
