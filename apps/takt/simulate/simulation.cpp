#include "apps/takt/simulate/simulation.hpp"

#include <memory>

#include "apps/takt/simulate/candump_log.hpp"
#include "apps/takt/simulate/front_simulation.hpp"
#include "apps/takt/simulate/outcome_ledger.hpp"
#include "apps/takt/simulate/sine_motion.hpp"
#include "master/rt/bus_loop.hpp"
#include "master/sim/bus/sim_port.hpp"
#include "master/sim/bus/world.hpp"

namespace takt {
namespace {

/// One run of the bus thread without a front thread.
class BusRun {
 public:
  BusRun(const LoadedNetwork& network, const SimulationOptions& options)
      : plan_{network.plan},
        options_{options},
        log_{network.plan, options.candump},
        ledger_{network.plan, log_.statistics(), options.seed},
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
  }

  SimulationOutcome run() {
    loop_.start();
    while (world_.now() < options_.duration) cycle();
    ledger_.keep_worst_tpdos();
    loop_.request_stop();
    const Time limit = world_.now() + plan_.stop_timeout + stop_slack;
    while (!loop_.done() && world_.now() < limit) cycle();
    world_.advance_to(world_.now() + plan_.cycle.period);  // the last frames leave the wire
    ledger_.mark_end_of_master();
    world_.advance_to(world_.now() + options_.after);
    StatusSnapshot snapshot;
    exchange_->status.read(snapshot);
    SimulationOutcome outcome = ledger_.finish(world_, snapshot, loop_.done());
    outcome.move = options_.move;
    outcome.axes_moved = motion_.most_moving();
    return outcome;
  }

 private:
  void cycle() {
    loop_.cycle();
    ImageView image;
    exchange_->images.take_newest(image);
    Event event;
    while (exchange_->events.pop(event)) ledger_.announce(event);
  }

  const BusPlan& plan_;
  const SimulationOptions& options_;
  CandumpLog log_;
  OutcomeLedger ledger_;
  sim::World world_;
  sim::SimPort port_;
  std::unique_ptr<Exchange> exchange_;
  SineMotion motion_;
  BusLoop<sim::SimPort> loop_;
};

}  // namespace

int exit_code_of(const SimulationOutcome& outcome) {
  if (outcome.stop != StopResult::confirmed) return 6;
  if (outcome.mandatory_failed) return 4;
  return unexpected_ends(outcome.motions) == 0 ? 0 : 1;
}

SimulationOutcome simulate(const LoadedNetwork& network, const SimulationOptions& options) {
  if (options.applications != 0 || !options.motions.empty()) {
    return simulate_front(network, options);
  }
  return std::make_unique<BusRun>(network, options)->run();
}

}  // namespace takt
