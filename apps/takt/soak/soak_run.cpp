#include "apps/takt/soak/soak_run.hpp"

#include <array>
#include <malloc.h>
#include <memory>

#include "apps/takt/soak/evidence/image_judge.hpp"
#include "apps/takt/soak/fault_walk.hpp"
#include "apps/takt/soak/intruder.hpp"
#include "apps/takt/soak/judge/node_judge.hpp"
#include "apps/takt/soak/judge/output_judge.hpp"
#include "apps/takt/soak/judged_port.hpp"
#include "apps/takt/soak/random_user.hpp"
#include "apps/takt/soak/soak_trace.hpp"
#include "master/explain/boot_report.hpp"
#include "master/rt/bus_loop.hpp"
#include "master/sim/bus/sim_port.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

constexpr Time calm = 1s;                         // time before the first fault
constexpr Time time_to_recover = 60s;             // time after the last fault
constexpr std::size_t memory_slack = 256 * 1024;  // bytes for open requests and event texts
constexpr std::array<Time, 4> latenesses{0us, 60us, 300us, 2ms};

sim::Faults faults_of(const BusPlan& plan, const SoakOptions& options) {
  return fault_walk(plan, sim::Random{options.seed}.fork(1), calm, calm + options.duration);
}

sim::WorldOptions world_options(const LoadedNetwork& network, const SoakOptions& options) {
  return {.seed = options.seed,
          .bitrate = network.plan.bitrate,
          .faults = faults_of(network.plan, options),
          .power_on_spread = 500ms};
}

sim::RemotePortOptions port_options(const LoadedNetwork& network, const SoakOptions& options) {
  const Time late = latenesses[sim::Random{options.seed}.fork(2).below(latenesses.size())];
  return {.sync = network.plan.cycle.sync_cob_id, .wake_jitter = late, .spin_jitter = late / 16};
}

/// One run: the simulated world, the master, its users and the judges.
class BusWalk {
 public:
  BusWalk(const LoadedNetwork& network, const SoakOptions& options)
      : plan_{network.plan},
        options_{options},
        random_{options.seed},
        images_{plan_, verdict_},
        outputs_{plan_, verdict_},
        nodes_{plan_, verdict_},
        listener_{plan_, options.candump,
                  [this](const sim::WireFrame& wire) { images_.on_wire(wire); }},
        world_{network.devices, world_options(network, options)},
        sim_port_{world_, port_options(network, options)},
        intruder_{world_, plan_, random_.fork(3)},
        port_{sim_port_, outputs_, intruder_},
        exchange_{std::make_unique<Exchange>(plan_)},
        user_{plan_, *exchange_, outputs_, verdict_, random_.fork(4)},
        loop_{plan_, port_, *exchange_} {
    world_.observe(&listener_);
  }

  SoakOutcome run() {
    loop_.start();
    walk();
    if (verdict_.good()) settle();
    if (verdict_.good()) stop();
    return {{.simulated = world_.now(),
             .images = images_.images(),
             .frames = images_.frames(),
             .random_frames = intruder_.sent(),
             .faults = faults_of(plan_, options_).size(),
             .requests = user_.asked(),
             .boots = nodes_.boots(status_),
             .events = events_},
            options_.seed,
            verdict_.violation()};
  }

 private:
  void cycle() {
    loop_.cycle();
    if (options_.defect) options_.defect(*exchange_, world_);
    const Time now = world_.now();
    exchange_->status.read(status_);
    verdict_.at(status_.bus.cycle, now);
    for (ImageView image; exchange_->images.take(image);) {
      images_.judge(image);
      user_.on_image(image, now);
    }
    for (Event event; exchange_->events.pop(event);) announce(event);
    user_.take_replies(now);
    nodes_.judge(status_, now);
  }

  void announce(const Event& event) {
    ++events_;
    if (options_.verbose) print_at(event.when, describe(plan_, event));
  }

  void walk() {
    const Time end = calm + options_.duration;
    const Time warm = calm + options_.duration / 4;
    std::size_t memory = 0;
    while (world_.now() < end && verdict_.good()) {
      user_.ask(world_.now());
      cycle();
      if (memory == 0 && world_.now() >= warm) memory = ::mallinfo2().uordblks;
    }
    const std::size_t now = ::mallinfo2().uordblks;
    if (now > memory + memory_slack) {
      verdict_.report_violation("memory stays flat", std::to_string(now - memory) +
                                                         " bytes more than at " +
                                                         std::to_string(warm / 1ms) + " ms");
    }
  }

  /// Switches all devices off and on, because random frames may have reconfigured them, and checks
  /// that all nodes come back and all requests are answered without further faults.
  void settle() {
    intruder_.leave();
    for (const NodePlan& node : plan_.nodes) world_.power(node.id, false);
    for (const Time until = world_.now() + 2s; world_.now() < until;) cycle();
    for (const NodePlan& node : plan_.nodes) world_.power(node.id, true);
    user_.reset_all(world_.now());
    const Time limit = world_.now() + time_to_recover;
    const auto settled = [&] { return nodes_.all_ready(status_) && user_.unanswered() == 0; };
    do {
      cycle();
    } while (!settled() && world_.now() < limit && verdict_.good());
    if (user_.unanswered() != 0) {
      verdict_.report_violation("every request is answered once",
                                std::to_string(user_.unanswered()) + " requests have no answer");
    }
    for (const Time until = world_.now() + 200ms; world_.now() < until;) cycle();
    nodes_.judge_end(status_);
  }

  void stop() {
    loop_.request_stop();
    const Time limit = world_.now() + plan_.stop_timeout + plan_.cycle.period;
    while (!loop_.done() && world_.now() <= limit) cycle();
    if (!loop_.done())
      verdict_.report_violation("the ordered stop ends in time", "the stop did not end");
  }

  const BusPlan& plan_;
  const SoakOptions& options_;
  sim::Random random_;
  Verdict verdict_;
  ImageJudge images_;
  OutputJudge outputs_;
  NodeJudge nodes_;
  Listener listener_;
  sim::World world_;
  sim::SimPort sim_port_;
  Intruder intruder_;
  JudgedPort port_;
  std::unique_ptr<Exchange> exchange_;
  RandomUser user_;
  BusLoop<JudgedPort> loop_;
  StatusSnapshot status_;
  std::uint64_t events_ = 0;
};

void report_faults(const BusPlan& plan, const SoakOptions& options) {
  for (const sim::Fault& fault : faults_of(plan, options)) {
    std::string text =
        fmt::format("fault until {:.3f} ms: {}", 1e-6 * static_cast<double>(fault.until.count()),
                    name(fault.kind));
    if (fault.node) text += fmt::format(" node {}", fault.node->value());
    if (fault.object) text += " " + to_string(*fault.object);
    print_at(fault.at, text);
  }
}

}  // namespace

SoakCounts& SoakCounts::operator+=(const SoakCounts& other) noexcept {
  simulated += other.simulated;
  images += other.images;
  frames += other.frames;
  random_frames += other.random_frames;
  faults += other.faults;
  requests += other.requests;
  boots += other.boots;
  events += other.events;
  commands += other.commands;
  moves += other.moves;
  motions += other.motions;
  arrivals += other.arrivals;
  groups += other.groups;
  gears += other.gears;
  streams += other.streams;
  judged_streams += other.judged_streams;
  judged_gears += other.judged_gears;
  homings += other.homings;
  forged += other.forged;
  program_faults += other.program_faults;
  return *this;
}

SoakOutcome soak(const LoadedNetwork& network, const SoakOptions& options) {
  if (options.verbose) report_faults(network.plan, options);
  return std::make_unique<BusWalk>(network, options)->run();
}

}  // namespace takt::soak
