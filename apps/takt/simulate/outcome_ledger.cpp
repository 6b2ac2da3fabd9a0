#include "apps/takt/simulate/outcome_ledger.hpp"

#include <algorithm>
#include <utility>

#include "master/explain/boot_report.hpp"
#include "master/explain/event_text.hpp"

namespace takt {
namespace {

constexpr std::size_t reported_events = 500;

}  // namespace

OutcomeLedger::OutcomeLedger(const BusPlan& plan, const WireStatistics& wire, std::uint64_t seed)
    : plan_{plan}, wire_{wire} {
  outcome_.bus = plan.name;
  outcome_.seed = seed;
  outcome_.period = plan.cycle.period;
  outcome_.bitrate = plan.bitrate;
  for (const NodePlan& node : plan_.nodes) {
    outcome_.nodes.push_back({.name = node.name, .id = node.id.value()});
  }
}

void OutcomeLedger::keep_worst_tpdos() {
  for (std::size_t row = 0; row < plan_.pdos.tpdos.size(); ++row) {
    NodeOutcome& node = outcome_.nodes[plan_.pdos.tpdos[row].node_index];
    node.worst_tpdo = std::max(node.worst_tpdo, wire_.tpdo(row).worst);
  }
}

void OutcomeLedger::announce(const Event& event) {
  ++outcome_.events_total;
  if (event.kind == EventKind::axis_not_stopped) {
    outcome_.unconfirmed.push_back(named_axis_stop_text(plan_, event));
  }
  for (NodeOutcome& node : outcome_.nodes) {
    if (node.id != event.node) continue;
    if (event.kind == EventKind::boot_done && !node.first_boot) node.first_boot = event.when;
    node.boot_failures += event.kind == EventKind::boot_failed;
  }
  if (outcome_.events.size() == reported_events) return;
  outcome_.events.push_back(
      {.when = event.when, .kind = event.kind, .node = event.node, .text = describe(plan_, event)});
}

SimulationOutcome OutcomeLedger::finish(sim::World& world, const StatusSnapshot& snapshot,
                                        bool stopped) {
  outcome_.simulated = world.now();
  outcome_.loop = snapshot.bus;
  outcome_.wire = world.bus().counters();
  outcome_.sync = wire_.sync();
  outcome_.worst_cycle_bits = wire_.worst_cycle_bits();
  outcome_.sdo_frames = wire_.sdo_frames();
  outcome_.emcy_frames = wire_.emcy_frames();
  outcome_.emcy_after = wire_.emcy_frames() - emcy_before_;
  outcome_.stopped = stopped;
  outcome_.stop = snapshot.bus.stop_result;
  for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
    outcome_.nodes[i].status = snapshot.nodes[i];
    const bool never_booted = plan_.nodes[i].boot && !outcome_.nodes[i].first_boot;
    outcome_.mandatory_failed |= plan_.nodes[i].mandatory && never_booted;
  }
  count_pdos(snapshot);
  return std::move(outcome_);
}

void OutcomeLedger::count_pdos(const StatusSnapshot& snapshot) {
  for (std::size_t row = 0; row < plan_.pdos.tpdos.size(); ++row) {
    NodeOutcome& node = outcome_.nodes[plan_.pdos.tpdos[row].node_index];
    node.tpdo_frames += wire_.tpdo(row).frames;
    node.tpdo_late += wire_.tpdo(row).late;
    node.tpdo_missing += snapshot.tpdos[row].missing;
  }
  for (std::size_t row = 0; row < plan_.pdos.rpdos.size(); ++row) {
    outcome_.nodes[plan_.pdos.rpdos[row].node_index].rpdo_frames += wire_.rpdo(row).frames;
  }
}

}  // namespace takt
