#include "apps/simulate/simulation.hpp"

#include <memory>

#include "apps/simulate/candump_log.hpp"
#include "apps/simulate/sine_motion.hpp"
#include "master/core/boot_report.hpp"
#include "master/core/stop_text.hpp"
#include "master/rt/bus_loop.hpp"
#include "master/sim/sim_port.hpp"
#include "master/sim/world.hpp"

namespace takt {
namespace {

constexpr std::size_t told_events = 500;
constexpr Time stop_slack = std::chrono::seconds{1};

/// One run: the world, the master in it, and what the front thread would do.
class Run {
 public:
  Run(const LoadedNetwork& network, const SimulationOptions& options)
      : plan_{network.plan},
        options_{options},
        log_{network.plan, options.candump},
        world_{network.devices,
               {.seed = options.seed, .bitrate = network.plan.bitrate, .faults = options.faults}},
        port_{world_,
              {.sync = network.plan.cycle.sync_cob_id,
               .wake_jitter = options.wake_jitter,
               .spin_jitter = options.wake_jitter / 8}},
        exchange_{std::make_unique<Exchange>(network.plan)},
        motion_{network.plan},
        loop_{network.plan, port_, *exchange_, {.controller = options.move ? &motion_ : nullptr}} {
    world_.observe(&log_);
    for (const NodePlan& node : plan_.nodes) {
      outcome_.nodes.push_back({.name = node.name, .id = node.id.value()});
    }
  }

  SimulationOutcome run() {
    loop_.start();
    while (world_.now() < options_.duration) cycle();
    keep_worst_tpdos();
    loop_.request_stop();
    const Time limit = world_.now() + plan_.stop_timeout + stop_slack;
    while (!loop_.done() && world_.now() < limit) cycle();
    world_.advance_to(world_.now() + plan_.cycle.period);  // the last frames leave the wire
    const std::uint64_t told_before = log_.statistics().emcy_frames();
    world_.advance_to(world_.now() + options_.after);
    outcome_.emcy_after = log_.statistics().emcy_frames() - told_before;
    finish();
    return std::move(outcome_);
  }

 private:
  void cycle() {
    loop_.cycle();
    ImageView image;
    exchange_->images.take_newest(image);
    Event event;
    while (exchange_->events.pop(event)) tell(event);
  }

  /// Before the stop, whose NMT commands delay the last TPDOs.
  void keep_worst_tpdos() {
    for (std::size_t row = 0; row < plan_.pdos.tpdos.size(); ++row) {
      NodeOutcome& node = outcome_.nodes[plan_.pdos.tpdos[row].node_index];
      node.worst_tpdo = std::max(node.worst_tpdo, log_.statistics().tpdo(row).worst);
    }
  }

  void tell(const Event& event) {
    ++outcome_.events_total;
    if (event.kind == EventKind::axis_not_stopped) {
      outcome_.unconfirmed.push_back(named_axis_stop_text(plan_, event));
    }
    for (NodeOutcome& node : outcome_.nodes) {
      if (node.id != event.node) continue;
      if (event.kind == EventKind::boot_done && !node.first_boot) node.first_boot = event.when;
      node.boot_failures += event.kind == EventKind::boot_failed;
    }
    if (outcome_.events.size() == told_events) return;
    outcome_.events.push_back({.when = event.when,
                               .kind = event.kind,
                               .node = event.node,
                               .text = describe(plan_, event)});
  }

  void finish() {
    StatusSnapshot snapshot;
    exchange_->status.read(snapshot);
    const WireStatistics& wire = log_.statistics();
    outcome_.bus = plan_.name;
    outcome_.seed = options_.seed;
    outcome_.simulated = world_.now();
    outcome_.period = plan_.cycle.period;
    outcome_.bitrate = plan_.bitrate;
    outcome_.loop = snapshot.bus;
    outcome_.wire = world_.bus().counters();
    outcome_.sync = wire.sync();
    outcome_.worst_cycle_bits = wire.worst_cycle_bits();
    outcome_.sdo_frames = wire.sdo_frames();
    outcome_.emcy_frames = wire.emcy_frames();
    outcome_.move = options_.move;
    outcome_.axes_moved = motion_.most_moving();
    outcome_.stopped = loop_.done();
    outcome_.stop = snapshot.bus.stop_result;
    for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
      outcome_.nodes[i].status = snapshot.nodes[i];
      const bool never_booted = plan_.nodes[i].boot && !outcome_.nodes[i].first_boot;
      outcome_.mandatory_failed |= plan_.nodes[i].mandatory && never_booted;
    }
    count_pdos(snapshot, wire);
  }

  void count_pdos(const StatusSnapshot& snapshot, const WireStatistics& wire) {
    for (std::size_t row = 0; row < plan_.pdos.tpdos.size(); ++row) {
      NodeOutcome& node = outcome_.nodes[plan_.pdos.tpdos[row].node_index];
      node.tpdo_frames += wire.tpdo(row).frames;
      node.tpdo_late += wire.tpdo(row).late;
      node.tpdo_missing += snapshot.tpdos[row].missing;
    }
    for (std::size_t row = 0; row < plan_.pdos.rpdos.size(); ++row) {
      outcome_.nodes[plan_.pdos.rpdos[row].node_index].rpdo_frames += wire.rpdo(row).frames;
    }
  }

  const BusPlan& plan_;
  const SimulationOptions& options_;
  CandumpLog log_;
  sim::World world_;
  sim::SimPort port_;
  std::unique_ptr<Exchange> exchange_;
  SineMotion motion_;
  BusLoop<sim::SimPort> loop_;
  SimulationOutcome outcome_;
};

}  // namespace

SimulationOutcome simulate(const LoadedNetwork& network, const SimulationOptions& options) {
  return std::make_unique<Run>(network, options)->run();
}

}  // namespace takt
