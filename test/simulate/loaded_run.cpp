#include "test/simulate/loaded_run.hpp"

#include <algorithm>
#include <map>
#include <memory>

#include "apps/takt/simulate/sine_motion.hpp"
#include "master/rt/bus_loop.hpp"
#include "master/sim/bus/sim_port.hpp"
#include "master/sim/bus/world.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time boots = 500ms;

class Loaded final : sim::BusObserver {
 public:
  Loaded(const LoadedNetwork& network, const BusBudget& budget, Time slowest, std::uint64_t seed)
      : plan_{network.plan},
        budget_{budget},
        world_{network.devices,
               {.seed = seed,
                .bitrate = plan_.bitrate,
                .faults = {{.kind = sim::FaultKind::slow_sdo, .at = boots, .time = slowest}}}},
        port_{world_, {.sync = plan_.cycle.sync_cob_id}},
        exchange_{std::make_unique<Exchange>(plan_)},
        motion_{plan_},
        loop_{plan_, port_, *exchange_, {.controller = &motion_}} {
    world_.observe(this);
    run_.worst.resize(budget.rows.size());
    for (std::size_t i = 0; i < budget.rows.size(); ++i) {
      if (budget.rows[i].frame.in_cycle) rows_.emplace(budget.rows[i].frame.cob_id, i);
    }
  }

  LoadedRun run(Time duration) {
    loop_.start();
    while (world_.now() < duration) {
      if (world_.now() > boots) ask();
      loop_.cycle();
      Reply reply;
      while (exchange_->replies.pop(reply)) ++run_.sdo_answers;
      Event event;
      while (exchange_->events.pop(event)) {
      }
    }
    return std::move(run_);
  }

 private:
  void ask() {
    const auto& nodes = plan_.nodes;
    while (exchange_->requests.push({.id = ++asked_,
                                     .kind = RequestKind::sdo_upload,
                                     .node = nodes[asked_ % nodes.size()].id.value(),
                                     .object = {.index = 0x1008, .sub = 0},
                                     .data = {}})) {
    }
  }

  /// SYNC is queued at multiples of the period, and an output not before its deadline.
  void on_wire(const sim::WireFrame& wire) noexcept override {
    const auto found = rows_.find(wire.frame.id);
    if (found == rows_.end() || wire.frame.rtr) return;
    const auto& frame = budget_.rows[found->second].frame;
    const bool output = frame.kind == Traffic::rpdo;
    const Time first = output ? plan_.cycle.output_deadline : Time{0};
    Time& worst = run_.worst[found->second];
    if (frame.kind != Traffic::tpdo) {
      worst = std::max(worst, (wire.end - first) % plan_.cycle.period + first);
    } else if (sync_ != Time{0}) {
      worst = std::max(worst, wire.end - sync_);
    }
    if (frame.kind != Traffic::sync) return;
    sync_ = wire.start - wire.start % plan_.cycle.period;
    run_.late_syncs += wire.start - sync_ > plan_.cycle.period / 10;
  }

  const BusPlan& plan_;
  const BusBudget& budget_;
  sim::World world_;
  sim::SimPort port_;
  std::unique_ptr<Exchange> exchange_;
  SineMotion motion_;
  BusLoop<sim::SimPort> loop_;
  std::map<CobId, std::size_t> rows_;
  LoadedRun run_;
  std::uint64_t asked_ = 0;
  Time sync_{};
};

}  // namespace

LoadedRun run_loaded(const LoadedNetwork& network, const BusBudget& budget, Time duration,
                     Time slowest, std::uint64_t seed) {
  return std::make_unique<Loaded>(network, budget, slowest, seed)->run(duration);
}

}  // namespace takt
