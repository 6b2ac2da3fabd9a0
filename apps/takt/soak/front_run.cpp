#include "apps/takt/soak/front_run.hpp"

#include <array>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <utility>

#include "apps/takt/simulate/program/forger.hpp"
#include "apps/takt/simulate/program/staged_port.hpp"
#include "apps/takt/simulate/program/virtual_application.hpp"
#include "apps/takt/simulate/program/virtual_daemon.hpp"
#include "apps/takt/simulate/program/virtual_lcm.hpp"
#include "apps/takt/soak/fault_walk.hpp"
#include "apps/takt/soak/judge/stop_judge.hpp"
#include "apps/takt/soak/judge/wire_judge.hpp"
#include "apps/takt/soak/random_program_faults.hpp"
#include "apps/takt/soak/soak_trace.hpp"
#include "master/sim/bus/world.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

constexpr Time front_calm = 2s;  // before the first fault; all nodes boot, and all axes move
constexpr Time front_recovery = 60s;
constexpr Time longest_pause = 21ms;  // longest result of pause_before_image, plus a step
constexpr Time usual_jitter = 320us;  // jitter of the master's SYNC
constexpr std::size_t most_applications = 3;
constexpr std::array<Time, 3> front_latenesses{0us, 60us, 300us};
constexpr Time longest_still = 5s;  // longest time between two motions of a program that is alive

/// Returns how the programs of this run command their axes.
Commanding commanding_of(const SoakOptions& options) {
  const bool by_turns = options.motions == MotionRuns::all || options.seed % 5 == 4;
  return by_turns ? Commanding::by_turns : Commanding::set_points;
}

/// Returns the nodes of one application: every `step`-th one, from `first` on.
std::vector<bool> every(std::size_t nodes, std::size_t first, std::size_t step) {
  std::vector<bool> mine(nodes);
  for (std::size_t i = first; i < nodes; i += step) mine[i] = true;
  return mine;
}

/// Returns the factor by which the pauses between faults are longer. Motions need some time without
/// faults until they end, and streams and gears need more to be compared with their paths.
int slowness_of(const SoakOptions& options) {
  if (commanding_of(options) == Commanding::set_points) return 1;
  return options.seed % 3 == 1 ? 16 : 4;
}

/// Returns the number of programs. In two thirds of the runs with motions, it is one, which moves
/// all axes as a group.
std::size_t applications_of(const BusPlan& plan, const SoakOptions& options) {
  const bool alone = commanding_of(options) == Commanding::by_turns && options.seed % 3 != 0;
  return alone ? 1 : std::min(most_applications, plan.nodes.size());
}

/// Returns the bus faults. Only half of the runs, those with an even seed, have any.
sim::Faults front_faults(const BusPlan& plan, const SoakOptions& options) {
  if (options.seed % 2 != 0) return {};
  return fault_walk(plan, sim::Random{options.seed}.fork(11), front_calm,
                    front_calm + options.duration, slowness_of(options));
}

sim::RemotePortOptions port_options(const BusPlan& plan, const SoakOptions& options) {
  const Time late =
      front_latenesses[sim::Random{options.seed}.fork(12).below(front_latenesses.size())];
  return {.sync = plan.cycle.sync_cob_id, .wake_jitter = late, .spin_jitter = late / 16};
}

/// Returns the plan of the daemon, which a test may have changed.
BusPlan daemon_plan(const BusPlan& plan, const FrontDefect& defect) {
  BusPlan copy = plan;
  if (defect.plan) defect.plan(copy);
  return copy;
}

class FrontWalk {
 public:
  FrontWalk(const LoadedNetwork& network, const SoakOptions& options)
      : plan_{network.plan},
        options_{options},
        random_{sim::Random{options.seed}.fork(10)},
        daemon_plan_{daemon_plan(plan_, options.front)},
        world_{network.devices,
               {.seed = options.seed,
                .bitrate = plan_.bitrate,
                .faults = front_faults(plan_, options),
                .power_on_spread = 100ms}},
        wire_{plan_, world_, verdict_},
        stop_{plan_, world_, verdict_},
        listener_{plan_, options.candump.empty() ? "" : options.candump + ".front",
                  [this](const sim::WireFrame& wire) {
                    if (wire.result == sim::WireResult::sent) wire_.heard(wire.frame);
                  }},
        clocks_{world_},
        lcm_{world_, random_.fork(1)},
        port_{world_, port_options(plan_, options), stage_,
              [this](std::span<const Frame> frames, Time now) { wire_.sent(frames, now); }},
        daemon_{daemon_plan_, port_, lcm_, clocks_, random_.fork(2)},
        forger_{plan_, lcm_,
                [this](SignalIndex signal, std::int64_t value) { wire_.forged(signal, value); },
                random_.fork(3)},
        applications_{make_applications()},
        rival_{make_application("axes 0", 7, applications_.front()->nodes())},
        program_faults_{{world_, lcm_, clocks_, daemon_, applications_, *rival_, forger_},
                        random_.fork(4),
                        {.from = front_calm,
                         .until = front_calm + options.duration,
                         .mean_pause = slowness_of(options) * Time{400ms}},
                        [this](Time until) { wire_.disturbed(until); },
                        options.verbose} {
    world_.observe(&listener_);
    daemon_.hear({.image = [this](const ImageView& image, Time now) { judge_wait(image, now); },
                  .notice = [this](const Notice& notice) { announce(notice); },
                  .event = [this](const Event& event) { hear(event); }});
    daemon_.on_round(options_.front.round);
    if (options_.front.command) {
      daemon_.rewrite(
          [this](command_t& command) { options_.front.command(command, seen_cycles()); });
    }
    if (options_.front.motion) {
      daemon_.rewrite([this](motion_command_t command) {
        return options_.front.motion(std::move(command), seen_cycles());
      });
    }
    if (options_.front.gear) daemon_.rewrite(options_.front.gear);
    if (options_.front.stream) daemon_.rewrite(options_.front.stream);
    stage_.add(program_faults_);
    stage_.add(daemon_);
    for (const auto& application : applications_) stage_.add(*application);
    stage_.add(*rival_);
    stage_.add(forger_);
  }

  SoakOutcome run() {
    daemon_.start();
    for (const auto& application : applications_) application->start();
    const Time end = front_calm + options_.duration;
    while (world_.now() < end && verdict_.good()) cycle();
    if (verdict_.good()) settle();
    if (verdict_.good()) stop();
    std::uint64_t commands = rival_->sent();
    for (const auto& application : applications_) commands += application->sent();
    return {{.simulated = world_.now(),
             .images = images_,
             .events = events_,
             .commands = commands,
             .moves = wire_.moves(),
             .motions = wire_.motions().orders().motions(),
             .arrivals = wire_.motions().arrivals(),
             .groups = wire_.motions().groups(),
             .gears = wire_.motions().orders().gears(),
             .streams = wire_.motions().orders().streams(),
             .judged_streams = wire_.motions().paths().streams(),
             .judged_gears = wire_.motions().paths().gears(),
             .forged = forger_.sent(),
             .program_faults = program_faults_.count()},
            options_.seed,
            verdict_.violation()};
  }

 private:
  std::unique_ptr<VirtualApplication> make_application(std::string name, unsigned number,
                                                       std::vector<bool> nodes) {
    ApplicationOptions options{.name = std::move(name),
                               .number = number,
                               .nodes = std::move(nodes),
                               .commanding = commanding_of(options_)};
    options.commanded = [this, number](const command_t& command, Time computed_from) {
      judge_command(command, {.sender = SenderBit{1} << number, .computed_from = computed_from});
    };
    options.motion_commanded = [this, number](const CommandedMotion& motion) {
      const motion_command_t& command = motion.command;
      if (!daemon_.runs() || command.session != daemon_.session()) return;
      const bool lasts = command.kind == "alive" || command.kind == "points";
      if (options_.verbose && !lasts) announce(number, command);
      wire_.commanded({.command = command,
                       .sender = SenderBit{1} << number,
                       .computed_from = motion.computed_from,
                       .points_until = motion.points_until,
                       .gear = motion.gear,
                       .stream = motion.stream},
                      world_.now());
    };
    options.released = [this, number](Time now) { wire_.released(SenderBit{1} << number, now); };
    options.deaf = [this](const std::string& what) {
      verdict_.report_violation("no message stops a program from using images", what);
    };
    const FrontDefect& defect = options_.front;
    if (defect.instance) options.instance = std::bind_front(defect.instance, number);
    if (defect.hears) options.hears = std::bind_front(defect.hears, number);
    return std::make_unique<VirtualApplication>(plan_, lcm_, std::move(options),
                                                random_.fork(100 + number));
  }
  SeenCycles seen_cycles() const noexcept {
    const auto newest = static_cast<std::int64_t>(cycle_);
    return {.newest = newest, .now = newest + (world_.now() - sync_.newest) / plan_.cycle.period};
  }
  void judge_command(const command_t& command, SentCommand sent) {
    sent.time_to_live = static_cast<std::uint32_t>(command.time_to_live);
    for (std::size_t i = 0; i < command.signals.size(); ++i) {
      wire_.commanded(static_cast<SignalIndex>(command.signals[i]), command.values[i], sent);
    }
  }
  std::vector<std::unique_ptr<VirtualApplication>> make_applications() {
    std::vector<std::unique_ptr<VirtualApplication>> all;
    const std::size_t count = applications_of(plan_, options_);
    for (unsigned i = 0; i < count; ++i) {
      all.push_back(
          make_application("axes " + std::to_string(i), i, every(plan_.nodes.size(), i, count)));
    }
    return all;
  }

  void cycle() {
    verdict_.at(cycle_, world_.now());
    if (daemon_.runs() && program_faults_.daemon_dies()) {
      daemon_.kill();
      wire_.begin_anew();
      program_faults_.daemon_died(world_.now());
      last_published_ = {};
    }
    if (daemon_.runs()) {
      wire_.begin_cycle(world_.now());
      daemon_.cycle();
    } else {
      port_.sleep_until(world_.now() + 1ms);
    }
  }

  /// Checks that the front thread receives an image soon after its publication, unless the front
  /// thread was stalled. If no image has come for some time, it polls less and less often and finds
  /// the next ones late; see pause_before_image. While no node exchanges PDOs, images are published
  /// before their predicted time. So is the first image after a change of the SYNC phase.
  void judge_wait(const ImageView& image, Time now) {
    ++images_;
    cycle_ = image.cycle;
    const Time before = std::exchange(last_published_, image.publish_time);
    const Time away = before == Time{} ? never : image.publish_time - before;
    const bool was_away = away > plan_.cycle.period * 3 / 2;
    const Time rare = was_away ? std::min(longest_pause, away / 8 + plan_.cycle.period) : Time{};
    const bool was_shifted = std::exchange(sync_.shifted, has_shifted(image.sync_time));
    const bool early = image.publish_time - before < plan_.cycle.period * 3 / 4;
    const Time usual = std::max(image.publish_time, before + plan_.cycle.period);
    const Time unforeseen = before + 2 * plan_.cycle.period;
    const Time regular = early ? unforeseen : usual;
    const Time expected = sync_.shifted || was_shifted ? std::max(regular, unforeseen) : regular;
    const Time in_time = expected + plan_.cycle.receive_window + 300us + rare;
    extended_until_ = std::max(extended_until_, in_time);
    if (daemon_.stalled_until() > image.publish_time || now <= extended_until_) return;
    verdict_.report_violation("each wait of the front thread ends in time",
                              "image " + std::to_string(image.cycle) + " waited for " +
                                  std::to_string((now - image.publish_time) / 1us) + " us");
  }

  /// Returns true if this SYNC is not a whole number of periods after the one before: the one
  /// before came late after a stall, or another producer sends SYNC.
  bool has_shifted(Time sync) noexcept {
    const Time period = plan_.cycle.period;
    const Time off = (sync - std::exchange(sync_.newest, sync)) % period;
    return std::min(off, period - off) > usual_jitter;
  }

  /// Runs on without new faults and checks that each application moves its axes again.
  void settle() {
    const Time limit = world_.now() + front_recovery;
    const auto leads = [&](const auto& application) {
      const Time still = commanding_of(options_) == Commanding::set_points ? 100ms : longest_still;
      return world_.now() - wire_.last_move(SenderBit{1} << application->number()) < still ||
             !has_axes(*application);
    };
    const Time since = world_.now() + 12s;  // even the longest fault is over by then
    while (verdict_.good() && world_.now() < since) cycle();
    // Bus faults may have left a device in another state, so the axes may not move.
    if (options_.seed % 2 == 0) return;
    while (verdict_.good() && world_.now() < limit && !std::ranges::all_of(applications_, leads)) {
      cycle();
    }
    for (const auto& application : applications_) {
      if (leads(application)) continue;
      verdict_.report_violation(
          "every application commands its axes again",
          application->text() + " does not command all of its axes after 60 s");
    }
  }

  /// Stops in order while the programs run on.
  void stop() {
    stop_.begin();
    wire_.begin_stop();
    daemon_.request_stop();
    const Time limit = world_.now() + plan_.stop_timeout + plan_.cycle.period;
    while (!daemon_.finished() && world_.now() <= limit && verdict_.good()) {
      cycle();
      stop_.look();
    }
    if (!daemon_.finished())
      verdict_.report_violation("the ordered stop ends in time", "the stop did not end");
    for (const Time until = world_.now() + 1s; world_.now() < until;) port_.sleep_until(until);
    StatusSnapshot status;
    daemon_.master().status(status);
    if (verdict_.good()) stop_.judge(status.bus.stop_result);
  }

  void hear(const Event& event) {
    ++events_;
    stop_.hear(event);
  }

  bool has_axes(const VirtualApplication& application) const {
    for (const Signal& signal : plan_.layout.signals) {
      if (signal.output && signal.object.index == 0x607A && application.commands(signal.node_index))
        return true;
    }
    return false;
  }

  void announce(unsigned program, const motion_command_t& command) const {
    std::string goals;
    for (const motion_goal_t& goal : command.goals) {
      goals += fmt::format(", {} to {} or by {} (limits {} {} {})", goal.node, goal.position,
                           goal.velocity, goal.max_velocity, goal.max_acceleration, goal.max_jerk);
    }
    print_at(world_.now(),
             fmt::format("program {}: {} {}{}", program, command.kind, command.id, goals));
  }

  void announce(const Notice& notice) const {
    if (options_.verbose) print_at(notice.when, notice.text);
  }

  const BusPlan& plan_;
  const SoakOptions& options_;
  sim::Random random_;
  BusPlan daemon_plan_;
  Verdict verdict_;
  sim::World world_;
  WireJudge wire_;
  StopJudge stop_;
  Listener listener_;
  VirtualClocks clocks_;
  VirtualLcm lcm_;
  Stage stage_;
  StagedPort port_;
  VirtualDaemon daemon_;
  Forger forger_;
  std::vector<std::unique_ptr<VirtualApplication>> applications_;
  std::unique_ptr<VirtualApplication> rival_;
  RandomProgramFaults program_faults_;
  std::uint64_t cycle_ = 0;
  std::uint64_t images_ = 0;
  std::uint64_t events_ = 0;
  struct {
    Time newest{};
    bool shifted = false;  ///< the newest SYNC is shifted against the one before
  } sync_;
  Time last_published_{};
  Time extended_until_{};
};

}  // namespace

SoakOutcome soak_front(const LoadedNetwork& network, const SoakOptions& options) {
  return std::make_unique<FrontWalk>(network, options)->run();
}

}  // namespace takt::soak
