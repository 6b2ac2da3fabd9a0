#include "test/budget/random_bus.hpp"

#include <algorithm>

#include "eds_parser/plan/cycle_compiler.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t rates[] = {125'000, 250'000, 500'000, 800'000, 1'000'000};
constexpr std::uint32_t first_cob_ids[2][4] = {{0x180, 0x280, 0x380, 0x480},
                                               {0x200, 0x300, 0x400, 0x500}};

/// Returns a COB-ID. The priorities of 29-bit identifiers are between those of 11-bit identifiers.
CobId random_id(sim::Random& random, std::uint32_t base) {
  if (!random.chance(0.1)) return CobId::base(base);
  return CobId::extended(base << 18 | random.below(1U << 18));
}

/// Sends a PDO by events, by a timer, or only on request of the master.
void set_events(sim::Random& random, PdoRow& row, bool tpdo) {
  row.transmission = 255;
  if (random.chance(0.6)) row.inhibit = 1ms * (1 + random.below(40));
  if (random.chance(0.5)) row.event_timer = 1ms * (1 + random.below(random.chance(0.7) ? 6 : 60));
  if (!tpdo || !random.chance(0.2)) return;
  if (random.chance(0.7)) row.transmission = static_cast<std::uint8_t>(252 + random.below(2));
  if (random.chance(0.5)) {
    row.poll = 1ms * (10 + random.below(100));
  } else {
    row.poll_syncs = static_cast<std::uint16_t>(1 + random.below(20));
  }
}

PdoRow random_pdo(sim::Random& random, const NodePlan& node, std::uint8_t index, bool tpdo,
                  std::uint16_t number, double by_event) {
  const std::uint32_t first = first_cob_ids[tpdo ? 0 : 1][number - 1];
  PdoRow row{.cob_id = random_id(random, first + node.id.value()),
             .node = node.id,
             .node_index = index,
             .number = number,
             .length = static_cast<std::uint8_t>(1 + random.below(8))};
  if (random.chance(0.4)) row.length = 8;
  if (random.chance(0.1)) row.transmission = static_cast<std::uint8_t>(2 + random.below(3));
  if (random.chance(by_event)) set_events(random, row, tpdo);
  return row;
}

/// Gives a node heartbeats, guarding, or neither.
void set_error_control(sim::Random& random, NodePlan& node) {
  if (random.chance(0.8)) {
    node.heartbeat_period = 1ms * (20 + random.below(200));
  } else if (random.chance(0.7)) {
    node.guard.period = 1ms * (20 + random.below(200));
  }
}

void add_nodes(sim::Random& random, BusPlan& plan, double by_event) {
  const std::uint32_t count = 1 + random.below(random.chance(0.5) ? 6 : 30);
  for (std::uint8_t i = 0; i < count; ++i) {
    NodePlan node{.name = "n" + std::to_string(i),
                  .id = *NodeId::from(i * 4u + 1 + random.below(4))};
    set_error_control(random, node);
    node.sdo_timeout = 500ms;
    for (std::uint16_t number = 1; number <= 4; ++number) {
      if (random.chance(number == 1 ? 0.95 : 0.25)) {
        plan.pdos.tpdos.push_back(random_pdo(random, node, i, true, number, by_event));
      }
      if (random.chance(number == 1 ? 0.9 : 0.2)) {
        plan.pdos.rpdos.push_back(random_pdo(random, node, i, false, number, by_event));
      }
    }
    plan.nodes.push_back(std::move(node));
  }
  std::ranges::sort(plan.pdos.rpdos, {}, &PdoRow::cob_id);
}

void set_turns(sim::Random& random, BusPlan& plan) {
  if (!random.chance(0.3)) return;
  plan.cycle.sync_overflow = 12;
  for (auto& row : plan.pdos.tpdos) {
    if (row.cyclic())
      row.sync_start = static_cast<std::uint8_t>(1 + random.below(row.transmission));
  }
}

}  // namespace

BusPlan random_bus(sim::Random& random, const BusKind& kind) {
  BusPlan plan{.name = "random", .bitrate = rates[random.below(std::size(rates))]};
  if (random.chance(0.8)) plan.master_heartbeat = 1ms * (50 + random.below(200));
  if (random.chance(0.3)) plan.time.period = 1ms * (100 + random.below(900));
  add_nodes(random, plan, kind.by_event);
  const auto span = kind.most_percent - kind.least_percent + 1;
  set_turns(random, plan);
  plan.cycle.period = 100ms;
  const TimeBudget wire = time_budget(plan);
  const auto needed = wire.inputs_wire + wire.outputs_wire;
  const auto percent = kind.least_percent + random.below(span);
  plan.cycle.period = std::chrono::ceil<std::chrono::microseconds>(needed * 100 / percent);
  plan.cycle.sync_followed = random.chance(kind.followed);
  Findings findings;
  NetworkReport report{"random", findings};
  compile_cycle(NetworkSpec{}, {}, plan, report);
  return plan;
}

}  // namespace takt
