#pragma once
#include <string>

#include "eds_parser/plan/cycle_compiler.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Compiles the times of the cycle anew.
inline void compile(BusPlan& plan) {
  Findings findings;
  NetworkReport report{"test", findings};
  compile_cycle(NetworkSpec{}, {}, plan, report);
}

/// Makes a bus of this number of nodes at 1 Mbit/s. Each node has a TPDO and an RPDO of eight bytes
/// at every SYNC, and a heartbeat every 100 ms.
inline BusPlan hand_made_bus(std::uint8_t nodes, Time period) {
  BusPlan plan{.name = "test"};
  plan.cycle.period = period;
  for (std::uint8_t i = 0; i < nodes; ++i) {
    const auto id = *NodeId::from(i + 1U);
    plan.nodes.push_back({.name = "n" + std::to_string(i + 1), .id = id});
    plan.nodes.back().heartbeat_period = std::chrono::milliseconds{100};
    for (const bool tpdo : {true, false}) {
      auto& rows = tpdo ? plan.pdos.tpdos : plan.pdos.rpdos;
      rows.push_back({.cob_id = CobId::base((tpdo ? 0x180U : 0x200U) + id.value()),
                      .node = id,
                      .node_index = i,
                      .length = 8});
    }
  }
  compile(plan);
  return plan;
}

}  // namespace takt
