#include "apps/takt/soak/homing_run.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/takt/simulate/motion/motion_programs.hpp"
#include "apps/takt/simulate/motion/virtual_process.hpp"
#include "apps/takt/simulate/program/agenda.hpp"
#include "apps/takt/simulate/program/staged_port.hpp"
#include "apps/takt/simulate/program/virtual_daemon.hpp"
#include "apps/takt/soak/homing_program.hpp"
#include "apps/takt/soak/judge/homing_judge.hpp"
#include "apps/takt/soak/soak_trace.hpp"
#include "master/lcm/channel_names.hpp"
#include "master/lcm/messages.hpp"
#include "master/sim/bus/world.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

constexpr Time without_faults = 3s;  // time before the first fault
constexpr Time mean_pause = 1500ms;
constexpr std::size_t most_programs = 2;
constexpr Time daemon_pause = 300ms;  // between the death and the restart of the daemon
constexpr std::size_t listener_room = 1000;

/// Returns the faults on the bus.
sim::Faults homing_faults(const BusPlan& plan, const SoakOptions& options) {
  sim::Random random = sim::Random{options.seed}.fork(31);
  constexpr std::array kinds{sim::FaultKind::power_off, sim::FaultKind::reset,
                             sim::FaultKind::mute_pdo, sim::FaultKind::device_error,
                             sim::FaultKind::stall_master};
  sim::Faults faults;
  Time at = without_faults;
  while ((at += random.up_to(2 * mean_pause)) < without_faults + options.duration) {
    sim::Fault fault{.kind = kinds[random.below(kinds.size())], .at = at};
    const bool is_short =
        fault.kind == sim::FaultKind::mute_pdo || fault.kind == sim::FaultKind::stall_master;
    fault.until = at + random.up_to(is_short ? Time{100ms} : Time{1s});
    fault.emcy_code = 0x2310;
    if (fault.kind != sim::FaultKind::stall_master) {
      fault.node = plan.nodes[random.below(static_cast<std::uint32_t>(plan.nodes.size()))].id;
    }
    faults.push_back(fault);
  }
  return faults;
}

/// Passes to the judge the messages about motions that programs receive.
class MotionListener final : public Actor {
 public:
  MotionListener(VirtualLcm& lcm, const BusPlan& plan, HomingJudge& judge)
      : lcm_{lcm.join(listener_room)}, judge_{judge} {
    lcm_.subscribe(channel_name(plan.name, "MOTION"));
  }
  Time next() const noexcept override { return lcm_.next_arrival(); }
  void act(Time now) override {
    lcm_.serve([&](std::string_view, std::span<const std::byte> data) {
      if (const auto motions = decode<motion_t>(data)) judge_.reported(*motions, now);
    });
  }

 private:
  VirtualEndpoint& lcm_;
  HomingJudge& judge_;
};

/// Faults of programs, at their times.
class Deaths final : public Actor {
 public:
  Time next() const noexcept override { return agenda.next(); }
  void act(Time now) override { agenda.act(now); }
  Agenda agenda;
};

class HomingWalk {
 public:
  HomingWalk(const LoadedNetwork& network, const SoakOptions& options)
      : plan_{network.plan},
        options_{options},
        random_{sim::Random{options.seed}.fork(30)},
        daemon_plan_{network.plan},
        faults_{homing_faults(plan_, options)},
        world_{network.devices,
               {.seed = options.seed, .bitrate = plan_.bitrate, .faults = faults_}},
        judge_{plan_, verdict_, HomingProgram::velocity},
        listener_{plan_, options.candump,
                  [this](const sim::WireFrame& wire) {
                    if (wire.result == sim::WireResult::sent)
                      judge_.heard(wire.frame, world_.now());
                  }},
        clocks_{world_},
        lcm_{world_, random_.fork(1)},
        motions_{lcm_, plan_, judge_},
        port_{
            world_, {.sync = plan_.cycle.sync_cob_id}, stage_, [](std::span<const Frame>, Time) {}},
        daemon_{changed(daemon_plan_), port_, lcm_, clocks_, random_.fork(2)} {
    world_.observe(&listener_);
    daemon_.hear({.image = [this](const ImageView& image, Time) { see(image); },
                  .notice = [this](const Notice& notice) { trace(notice.text); },
                  .event = [this](const Event&) { ++events_; }});
    stage_.add(deaths_);
    stage_.add(daemon_);
    stage_.add(motions_);
    make_programs();
    plan_deaths();
  }

  SoakOutcome run() {
    daemon_.start();
    while (world_.now() < without_faults + options_.duration && verdict_.good()) cycle();
    for (const auto& program : programs_) count(*program);
    return {{.simulated = world_.now(),
             .images = images_,
             .faults = faults_.size(),
             .events = events_,
             .arrivals = arrivals_,
             .homings = homings_,
             .program_faults = deaths_of_programs_},
            options_.seed,
            verdict_.violation()};
  }

 private:
  struct Program {
    std::vector<std::string> axes;
    std::vector<std::size_t> numbers;
    std::unique_ptr<VirtualProcess> process{};
    std::unique_ptr<HomingProgram> code{};
  };

  const BusPlan& changed(BusPlan& plan) const {
    if (options_.front.plan) options_.front.plan(plan);
    return plan;
  }

  /// Makes two programs that share the axes alternately, or a single program that has all axes.
  void make_programs() {
    const std::vector<std::string> names = motion_axis_names(plan_);
    const std::size_t count = options_.seed % 2 == 0 ? 1 : std::min(most_programs, names.size());
    for (std::size_t i = 0; i < count; ++i) {
      Program& program = *programs_.emplace_back(std::make_unique<Program>());
      for (std::size_t axis = i; axis < names.size(); axis += count) {
        program.axes.push_back(names[axis]);
        program.numbers.push_back(axis);
      }
      program.process = std::make_unique<VirtualProcess>(lcm_, clocks_, random_.fork(10 + i));
      stage_.add(*program.process);
      start(program);
    }
  }

  void start(Program& program) {
    VirtualProcess& process = *program.process;
    HomingProgram::Setting setting{.bus = plan_.name,
                                   .axes = program.axes,
                                   .numbers = program.numbers,
                                   .connect = [&process] { return process.connect(); },
                                   .is_killed = [&process] { return process.is_killed(); }};
    if (options_.verbose) {
      setting.trace = [this, name = program.axes.front()](const std::string& what) {
        trace("program of " + name + ": " + what);
      };
    }
    program.code =
        std::make_unique<HomingProgram>(std::move(setting), judge_, random_.fork(20 + ++starts_));
    process.start([&code = *program.code] { code.run(); });
  }

  void plan_deaths() {
    sim::Random random = random_.fork(3);
    Time at = without_faults;
    while ((at += random.up_to(4 * mean_pause)) < without_faults + options_.duration) {
      if (random.chance(0.15)) {
        deaths_.agenda.add(at, [this] { daemon_dies_ = daemon_.runs(); });
        continue;
      }
      Program& program = *programs_[random.below(static_cast<std::uint32_t>(programs_.size()))];
      deaths_.agenda.add(at, [this, &program] { kill(program); });
    }
  }

  void kill(Program& program) {
    trace("the program of " + program.axes.front() + " is killed");
    program.process->kill();
    ++deaths_of_programs_;
    count(program);
    start(program);
  }

  void count(Program& program) {
    program.process->kill();
    homings_ += program.code->homed();
    arrivals_ += program.code->arrived();
  }

  void cycle() {
    verdict_.at(cycle_, world_.now());
    if (daemon_.runs() && std::exchange(daemon_dies_, false)) {
      trace("taktd is killed");
      daemon_.kill();
      judge_.begin_anew(world_.now());
      ++deaths_of_programs_;
      deaths_.agenda.add(world_.now() + daemon_pause, [this] { daemon_.start(); });
    }
    if (daemon_.runs()) {
      daemon_.cycle();
    } else {
      port_.sleep_until(world_.now() + 1ms);
    }
  }

  void see(const ImageView& image) {
    ++images_;
    cycle_ = image.cycle;
  }

  void trace(const std::string& text) const {
    if (options_.verbose) print_at(world_.now(), text);
  }

  const BusPlan& plan_;
  const SoakOptions& options_;
  sim::Random random_;
  BusPlan daemon_plan_;
  sim::Faults faults_;
  Verdict verdict_;
  sim::World world_;
  HomingJudge judge_;
  Listener listener_;
  VirtualClocks clocks_;
  VirtualLcm lcm_;
  MotionListener motions_;
  Stage stage_;
  StagedPort port_;
  VirtualDaemon daemon_;
  Deaths deaths_;
  bool daemon_dies_ = false;
  std::vector<std::unique_ptr<Program>> programs_;
  std::uint64_t starts_ = 0;
  std::uint64_t deaths_of_programs_ = 0;
  std::uint64_t cycle_ = 0;
  std::uint64_t images_ = 0;
  std::uint64_t events_ = 0;
  std::uint64_t homings_ = 0;
  std::uint64_t arrivals_ = 0;
};

}  // namespace

SoakOutcome soak_homing(const LoadedNetwork& network, const SoakOptions& options) {
  return std::make_unique<HomingWalk>(network, options)->run();
}

}  // namespace takt::soak
