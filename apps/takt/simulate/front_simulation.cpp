#include "apps/takt/simulate/front_simulation.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "apps/takt/simulate/candump_log.hpp"
#include "apps/takt/simulate/motion/motion_programs.hpp"
#include "apps/takt/simulate/outcome_ledger.hpp"
#include "apps/takt/simulate/program/program_fault_actor.hpp"
#include "apps/takt/simulate/program/staged_port.hpp"
#include "master/sim/bus/world.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr unsigned rival_number = 7;  // identifies the rivals in the low bits of positions
constexpr Time last_words = 50ms;     // time for the front thread to report the result of the stop
constexpr Time without_taktd = 1ms;   // step of the simulation while taktd does not run

/// Returns the nodes of one application. The CiA 402 nodes without an axis in `motions` are
/// distributed round-robin.
std::vector<bool> nodes_of(const BusPlan& plan, const MotionScripts& motions,
                           std::size_t application, std::size_t applications) {
  std::vector<bool> mine(plan.nodes.size());
  std::size_t drive = 0;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    const bool is_free = !commands_node(motions, plan.nodes[i].name);
    if (plan.nodes[i].cia402 && is_free) mine[i] = drive++ % applications == application;
  }
  return mine;
}

class FrontRun {
 public:
  FrontRun(const LoadedNetwork& network, const SimulationOptions& options)
      : plan_{network.plan},
        options_{options},
        random_{sim::Random{options.seed}.fork(20)},
        log_{plan_, options.candump},
        ledger_{plan_, log_.statistics(), options.seed},
        world_{network.devices,
               {.seed = options.seed, .bitrate = plan_.bitrate, .faults = options.faults}},
        clocks_{world_},
        lcm_{world_, random_.fork(1)},
        port_{world_,
              {.sync = plan_.cycle.sync_cob_id,
               .wake_jitter = options.wake_jitter,
               .spin_jitter = options.wake_jitter / 8},
              stage_,
              [](std::span<const Frame>, Time) {}},
        daemon_{plan_, port_, lcm_, clocks_, random_.fork(2)},
        forger_{plan_, lcm_, [](SignalIndex, std::int64_t) {}, random_.fork(3)},
        applications_{make_programs(Part::application)},
        rivals_{make_programs(Part::rival)},
        motions_{plan_, options.motions, lcm_, clocks_, random_.fork(4), options.duration},
        program_faults_{
            {lcm_, daemon_, applications_, rivals_, forger_}, options.programs, options.faults} {
    world_.observe(&log_);
    daemon_.hear({.image = [this](const ImageView& image, Time) { motions_.see(image); },
                  .notice = {},
                  .event = [this](const Event& event) { announce(event); }});
    stage_.add(program_faults_);
    stage_.add(daemon_);
    for (const auto& one : applications_) stage_.add(*one);
    for (const auto& one : rivals_) stage_.add(*one);
    stage_.add(forger_);
    motions_.join(stage_);
  }

  SimulationOutcome run() {
    daemon_.start();
    for (const auto& application : applications_) application->start();
    while (world_.now() < options_.duration) cycle();
    ledger_.keep_worst_tpdos();
    const bool stopped = stop();
    ledger_.mark_end_of_master();
    world_.advance_to(world_.now() + options_.after);
    count_daemon();
    SimulationOutcome outcome = ledger_.finish(world_, snapshot_, stopped);
    outcome.motions = motions_.end();
    outcome.programs = options_.motions.size();
    outcome.axes_moved = most_led_ + moved_axes(outcome.motions);
    for (const auto& one : applications_) {
      front_.applications.push_back({one->name(), one->images(), one->sent(), one->dropped()});
    }
    front_.lost = daemon_.lost();
    outcome.front = std::move(front_);
    return outcome;
  }

 private:
  enum class Part : std::uint8_t { application, rival };

  VirtualApplications make_programs(Part part) {
    VirtualApplications all;
    for (unsigned i = 0; i < options_.applications; ++i) {
      const unsigned number = part == Part::rival ? rival_number : i;
      all.push_back(std::make_unique<VirtualApplication>(
          plan_, lcm_,
          ApplicationOptions{.name = "axes " + std::to_string(i + 1),
                             .number = number,
                             .nodes = nodes_of(plan_, options_.motions, i, options_.applications)},
          random_.fork(100 + i + 10 * number)));
    }
    return all;
  }

  void cycle() {
    if (daemon_.runs() && program_faults_.daemon_dies()) {
      count_daemon();
      daemon_.kill();
      program_faults_.daemon_died(world_.now());
    }
    if (!daemon_.runs()) return port_.sleep_until(world_.now() + without_taktd);
    daemon_.cycle();
    std::size_t led = 0;
    for (const auto& application : applications_) led += application->leads();
    most_led_ = std::max(most_led_, led);
  }

  /// Stops in order while the applications run on. Returns true if the stop was completed.
  bool stop() {
    if (!daemon_.runs()) return false;
    daemon_.request_stop();
    const Time limit = world_.now() + plan_.stop_timeout + stop_slack;
    while (daemon_.runs() && !daemon_.finished() && world_.now() < limit) cycle();
    const bool stopped = daemon_.runs() && daemon_.finished();
    port_.sleep_until(world_.now() + std::max(last_words, plan_.cycle.period));
    if (daemon_.runs()) daemon_.hear_the_end();
    return stopped;
  }

  void announce(const Event& event) {
    front_.fallbacks += event.kind == EventKind::fallback_begun;
    ledger_.announce(event);
  }

  /// Adds the counters of the present taktd process to the outcome.
  void count_daemon() {
    if (!daemon_.runs()) return;
    daemon_.master().status(snapshot_);
    const Bridge& bridge = daemon_.bridge();
    ++front_.starts;
    front_.images += bridge.images();
    front_.commands_taken += bridge.commands_taken();
    front_.damaged += bridge.damaged();
    front_.gaps += bridge.long_gaps();
    for (std::size_t i = 0; i < command_refusals; ++i) front_.refused[i] += bridge.refusals()[i];
  }

  const BusPlan& plan_;
  const SimulationOptions& options_;
  sim::Random random_;
  CandumpLog log_;
  OutcomeLedger ledger_;
  sim::World world_;
  VirtualClocks clocks_;
  VirtualLcm lcm_;
  Stage stage_;
  StagedPort port_;
  VirtualDaemon daemon_;
  Forger forger_;
  VirtualApplications applications_;
  VirtualApplications rivals_;
  MotionPrograms motions_;
  ProgramFaultActor program_faults_;
  StatusSnapshot snapshot_;
  FrontOutcome front_;
  std::size_t most_led_ = 0;
};

}  // namespace

SimulationOutcome simulate_front(const LoadedNetwork& network, const SimulationOptions& options) {
  return std::make_unique<FrontRun>(network, options)->run();
}

}  // namespace takt
