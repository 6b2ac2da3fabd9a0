#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "eds_parser/table/bus_plan.hpp"

namespace takt::test {

/// Adds a PDO of a node with its fields and returns the row of the PDO.
inline PdoRow& add_pdo(BusPlan& plan, bool transmit, PdoRow row,
                       std::initializer_list<PdoField> fields) {
  row.first_field = static_cast<std::uint16_t>(plan.pdos.fields.size());
  row.field_count = static_cast<std::uint16_t>(fields.size());
  unsigned bits = 0;
  for (const PdoField& field : fields) {
    plan.pdos.fields.push_back(field);
    bits = std::max(bits, unsigned{field.bit_offset} + field.bits);
  }
  row.length = static_cast<std::uint8_t>((bits + 7) / 8);
  auto& rows = transmit ? plan.pdos.tpdos : plan.pdos.rpdos;
  if (transmit) plan.pdos.route[row.cob_id.id()] = static_cast<std::uint16_t>(rows.size());
  rows.push_back(row);
  return rows.back();
}

inline Signal make_signal(NodeId node, unsigned node_index, ObjectKey object) {
  return {.name = "signal",
          .node = node,
          .node_index = static_cast<std::uint8_t>(node_index),
          .object = object,
          .row = static_cast<std::uint16_t>(node_index),
          .unit = {},
          .safe_value = {},
          .seeded_from = {}};
}

inline NodePlan make_node(std::string name, NodeId id) {
  return {.name = std::move(name),
          .id = id,
          .description_file = {},
          .product_name = {},
          .boot_plan = {}};
}

struct AxesOptions {
  unsigned nodes = 2;
  std::uint8_t tpdo_type = 1;
  std::uint8_t rpdo_type = 1;
  Time period = std::chrono::milliseconds{2};
  std::uint32_t fallback_cycles = 3;
};

/// `n` axes: TPDO1 statusword and position, RPDO1 controlword and target position. Node-IDs start
/// at 1. The signals are the statuswords, positions, controlwords and targets; each kind is a block
/// with one signal per axis.
inline BusPlan axes(AxesOptions options = {}) {
  const unsigned n = options.nodes;
  BusPlan plan;
  plan.name = "test";
  plan.cycle.period = options.period;
  plan.cycle.receive_window = options.period * 6 / 10;
  plan.cycle.output_deadline = options.period * 8 / 10;
  plan.cycle.quiet_before_sync = options.period / 20;
  plan.layout.inputs = 2 * n;
  const auto add_column = [&](std::uint16_t index, std::uint8_t bits, DataType type, bool output) {
    for (unsigned i = 0; i < n; ++i) {
      Signal signal = make_signal(NodeId::from(i + 1).value(), i, {index, 0});
      signal.type = type;
      signal.bits = bits;
      signal.output = output;
      if (output) signal.fallback_cycles = options.fallback_cycles;
      if (index == 0x6040) {
        signal.fallback = Fallback::value;
        signal.fallback_value = 0x0002;
      }
      if (index == 0x607A) signal.seeded_from = static_cast<SignalIndex>(n + i);
      plan.layout.signals.push_back(signal);
    }
  };
  add_column(0x6041, 16, DataType::unsigned16, false);
  add_column(0x6064, 32, DataType::integer32, false);
  add_column(0x6040, 16, DataType::unsigned16, true);
  add_column(0x607A, 32, DataType::integer32, true);
  for (unsigned i = 0; i < n; ++i) {
    const NodeId node = NodeId::from(i + 1).value();
    const auto signal = [&](unsigned column) { return static_cast<SignalIndex>(column * n + i); };
    plan.nodes.push_back(make_node("axis" + std::to_string(i + 1), node));
    plan.nodes.back().cia402 = true;
    add_pdo(plan, true,
            {.cob_id = CobId::base(0x180 + i + 1),
             .node = node,
             .node_index = static_cast<std::uint8_t>(i),
             .transmission = options.tpdo_type},
            {{.signal = signal(0), .bit_offset = 0, .bits = 16},
             {.signal = signal(1), .bit_offset = 16, .bits = 32, .sign_extend = true}});
    add_pdo(plan, false,
            {.cob_id = CobId::base(0x200 + i + 1),
             .node = node,
             .node_index = static_cast<std::uint8_t>(i),
             .transmission = options.rpdo_type},
            {{.signal = signal(2), .bit_offset = 0, .bits = 16},
             {.signal = signal(3), .bit_offset = 16, .bits = 32, .sign_extend = true}});
  }
  return plan;
}

}  // namespace takt::test
