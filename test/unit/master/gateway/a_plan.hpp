#pragma once
#include "eds_parser/table/bus_plan.hpp"

namespace takt::test {

/// A plan with node 5, which has the input statusword and the outputs controlword (u16) and target
/// (i32), and node 6, which has one u8 output.
inline BusPlan a_plan() {
  BusPlan plan;
  plan.name = "lift";
  plan.cycle.period = std::chrono::milliseconds{2};
  const auto node = [&](NodeId id, const char* name) {
    NodePlan made{
        .name = name, .id = id, .description_file = {}, .product_name = {}, .boot_plan = {}};
    made.boot = true;
    plan.nodes.push_back(made);
  };
  node(5_node, "shoulder");
  node(6_node, "io");
  const auto signal = [&](const char* name, std::uint8_t index, DataType type, bool output) {
    Signal made{.name = name,
                .node = plan.nodes[index].id,
                .object = {},
                .unit = {},
                .safe_value = {},
                .seeded_from = {}};
    made.node_index = index;
    made.type = type;
    made.bits = static_cast<std::uint8_t>(bit_width(type));
    made.output = output;
    plan.layout.signals.push_back(made);
  };
  signal("statusword", 0, DataType::unsigned16, false);
  signal("controlword", 0, DataType::unsigned16, true);
  signal("target_position", 0, DataType::integer32, true);
  signal("outputs", 1, DataType::unsigned8, true);
  plan.layout.inputs = 1;
  plan.layout.hash = 77;
  return plan;
}

}  // namespace takt::test
