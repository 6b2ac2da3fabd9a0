#pragma once
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt::bench {

struct EightOptions {
  unsigned nodes = 1;
  bool rpdos = true;
  Time period = std::chrono::milliseconds{4};
  std::uint32_t bitrate = 1'000'000;
};

/// Makes a plan of `nodes` devices with one TPDO and one RPDO of eight UNSIGNED8 each. The figures
/// of the master that takt is compared with were measured with this load.
inline BusPlan eight_u8(EightOptions options) {
  BusPlan plan;
  plan.name = "bench";
  plan.bitrate = options.bitrate;
  plan.cycle.period = options.period;
  plan.cycle.receive_window = options.period * 6 / 10;
  plan.cycle.output_deadline = options.period * 8 / 10;
  plan.layout.inputs = 8 * options.nodes;
  const unsigned directions = options.rpdos ? 2 : 1;
  for (unsigned d = 0; d < directions; ++d) {
    for (unsigned i = 0; i < 8 * options.nodes; ++i) {
      const unsigned node = i / 8;
      Signal signal = test::make_signal(*NodeId::from(node + 1), node,
                                        {static_cast<std::uint16_t>(d == 0 ? 0x6000 : 0x6200),
                                         static_cast<std::uint8_t>(i % 8 + 1)});
      signal.type = DataType::unsigned8;
      signal.bits = 8;
      signal.output = d == 1;
      plan.layout.signals.push_back(signal);
    }
  }
  for (unsigned node = 0; node < options.nodes; ++node) {
    plan.nodes.push_back(test::make_node("io" + std::to_string(node + 1), *NodeId::from(node + 1)));
    for (unsigned d = 0; d < directions; ++d) {
      PdoRow row{.cob_id = CobId::base((d == 0 ? 0x180 : 0x200) + node + 1),
                 .node = *NodeId::from(node + 1),
                 .node_index = static_cast<std::uint8_t>(node),
                 .length = 8,
                 .first_field = static_cast<std::uint16_t>(plan.pdos.fields.size()),
                 .field_count = 8};
      for (unsigned i = 0; i < 8; ++i) {
        plan.pdos.fields.push_back(
            {.signal = static_cast<SignalIndex>(d * plan.layout.inputs + 8 * node + i),
             .bit_offset = static_cast<std::uint8_t>(8 * i),
             .bits = 8});
      }
      if (d == 0) {
        plan.pdos.route[row.cob_id.id()] = static_cast<std::uint16_t>(node);
        plan.pdos.tpdos.push_back(row);
      } else {
        plan.pdos.rpdos.push_back(row);
      }
    }
  }
  return plan;
}

}  // namespace takt::bench
