#include <CLI/CLI.hpp>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <iostream>
#include <map>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/duration.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/soak/soak_jobs.hpp"

namespace takt {
namespace soak {
namespace {

struct SoakArguments {
  std::string network;
  std::string seeds = "1..100";
  std::string run_for = "20s";
  double hours = 0;
  std::string part = "both";
  SoakPlan plan;
};

const std::map<std::string, SoakPart> parts{{"bus", SoakPart::bus},
                                            {"front", SoakPart::front},
                                            {"both", SoakPart::both},
                                            {"homing", SoakPart::homing}};

/// Sums over all runs.
struct Sum {
  std::uint64_t runs = 0;
  std::uint64_t bad = 0;
  SoakCounts total;
};

/// Parses a seed or a range of seeds, `17` or `1..200`. Returns false if the text is neither.
bool parse_seeds(const std::string& text, SoakPlan& plan) {
  const char* const end = text.data() + text.size();
  auto read = std::from_chars(text.data(), end, plan.first);
  plan.last = plan.first;
  if (read.ec == std::errc{} && std::string_view{read.ptr, end}.starts_with("..")) {
    read = std::from_chars(read.ptr + 2, end, plan.last);
  }
  return read.ec == std::errc{} && read.ptr == end && plan.first >= 1 && plan.last >= plan.first;
}

void announce(const SoakArguments& arguments, const SoakReport& report) {
  const SoakOutcome& outcome = report.outcome;
  std::cout << "seed " << outcome.seed << ": ";
  if (report.signal != 0) {
    std::cout << "the process died: " << (report.signal > 0 ? ::strsignal(report.signal) : "exit");
  } else {
    const Violation& violation = *outcome.violation;
    std::cout << "cycle " << violation.cycle << " ("
              << 1e-9 * static_cast<double>(violation.when.count())
              << " s): violated: " << violation.invariant << ": " << violation.what;
  }
  std::cout << "\n  repeat with: takt soak " << arguments.network << " --seeds " << outcome.seed
            << " --part " << arguments.part << " --for " << arguments.run_for << " --verbose"
            << std::endl;
}

int run(const SoakArguments& arguments) {
  const LoadedNetwork network = load_network(arguments.network);
  if (print_findings(network.findings)) return 2;
  SoakPlan plan = arguments.plan;
  plan.run.duration = *parse_duration(arguments.run_for);
  if (!parse_seeds(arguments.seeds, plan)) {
    throw Failure{"--seeds " + arguments.seeds + " is not a seed like 17 or a range like 1..200",
                  2};
  }
  plan.part = parts.at(arguments.part);
  if (arguments.hours > 0) {
    const auto walks = plan.part == SoakPart::both ? 2 : 1;
    const double one =
        std::chrono::duration<double, std::ratio<3600>>(walks * plan.run.duration).count();
    plan.last = plan.first + static_cast<std::uint64_t>(std::ceil(arguments.hours / one)) - 1;
  }
  Sum sum;
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [start] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  double next_word = 10;
  run_jobs(network, plan, [&](const SoakReport& report) {
    const bool bad = report.signal != 0 || report.outcome.violation;
    ++sum.runs;
    sum.bad += bad;
    sum.total += report.outcome;
    if (bad) announce(arguments, report);
    if (elapsed() < next_word) return;
    next_word = elapsed() + 10;
    std::cerr << sum.runs << " of " << plan.last - plan.first + 1 << " seeds\n";
  });
  const SoakCounts& total = sum.total;
  const double hours = std::chrono::duration<double, std::ratio<3600>>(total.simulated).count();
  std::cout << sum.runs << " seeds, " << hours << " h of bus '" << network.plan.name
            << "': " << total.images << " images, " << total.frames << " frames ("
            << total.random_frames << " random), " << total.faults << " faults, " << total.boots
            << " boots, " << total.requests << " requests, " << total.events << " events, "
            << total.commands << " commands (" << total.forged << " forged), " << total.moves
            << " moves, " << total.motions << " motions (" << total.arrivals << " arrived, "
            << total.groups << " groups seen to begin, " << total.gears << " gears ("
            << total.judged_gears << " compared with their leaders), " << total.streams
            << " streams (" << total.judged_streams << " compared with their paths)), "
            << total.homings << " homings, " << total.program_faults << " program faults; "
            << sum.bad << (sum.bad == 1 ? " violation" : " violations") << std::endl;
  std::cerr << static_cast<long>(hours * 3600 / elapsed()) << " times real time\n";
  return sum.bad == 0 ? 0 : 1;
}

}  // namespace
}  // namespace soak

void add_soak(CLI::App& app, int& exit_code) {
  auto [command, arguments] = add_command<soak::SoakArguments>(
      app, exit_code, "soak", "runs random fault sequences in virtual time and checks invariants",
      soak::run);
  command.add_option("NET.yaml", arguments.network, "network file")->required();
  command.add_option("--seeds,--seed", arguments.seeds, "one run for each seed: 17 or 1..200")
      ->capture_default_str();
  command.add_option("--for", arguments.run_for, "time in which faults happen in each run")
      ->check(duration_error)
      ->capture_default_str();
  command
      .add_option(
          "--part", arguments.part,
          "run the bus part or the front thread part of each seed, or both parts; `homing` runs "
          "programs that home axes")
      ->check(one_of({"bus", "front", "both", "homing"}))
      ->capture_default_str();
  command
      .add_option("--hours", arguments.hours,
                  "run as many seeds as give this number of hours on the bus")
      ->check(CLI::PositiveNumber);
  add_number(command, "--jobs", arguments.plan.jobs, "number of processes")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command.add_option("--candump", arguments.plan.run.candump,
                     "write all frames of one seed (front thread part: FILE.front)");
  arguments.plan.run.motions = soak::MotionRuns::all;
  command.add_flag_callback(
      "--few-motions", [plan = &arguments.plan] { plan->run.motions = soak::MotionRuns::some; },
      "let the programs command motions with every fifth seed only, and set-points with the "
      "others");
  command
      .add_flag_callback(
          "--motions", [plan = &arguments.plan] { plan->run.motions = soak::MotionRuns::all; },
          "the default: the programs command motions with each seed")
      ->group("");
  command.add_flag("--verbose", arguments.plan.run.verbose, "print faults and events of one seed");
  command.footer(
      "The bus part has lost, late, doubled and broken frames, babbling nodes, arbitrary frames,\n"
      "devices that disappear, appear, reset during their boot, are exchanged or stop answering,\n"
      "EMCY and boot-up storms, bus-off, a stalled master, silent applications, requests at any\n"
      "time. takt checks: no image is torn, cycle numbers rise, no output is stale, SYNCs do not\n"
      "come in bursts, every node is in a named state, every wait ends, every request is\n"
      "answered once, memory use stays flat, all nodes come back, the stop ends in time.\n"
      "The front thread part runs taktd with its LCM gateway and several programs that move\n"
      "axes. The programs are stalled, die, end, restart, jump, or have the name of another\n"
      "program; messages are delayed, repeated, forged and damaged. The programs command motions\n"
      "and set-points by turns. takt checks: no output is older than its time to live by the true\n"
      "clock, no axis moves without a command of a living program, motions keep their limits and\n"
      "end along them, groups begin together, no program moves what another one holds, no output\n"
      "leaves `limits:`, no wait of the front thread is too long, every program receives its\n"
      "messages, no stop confirms an axis that did not come to rest or was not disabled.\n"
      "The homing part runs taktd with programs that home axes and move them, while drives lose\n"
      "power, reset or report errors, SYNC is missing, and programs die. takt checks: no\n"
      "set-point jumps, an axis is homed only after a good run, and no axis goes to a position\n"
      "without it where `homing:` requires it.\n"
      "Exit code 1: an invariant was violated; each line names seed, cycle and invariant.\n\n"
      "Example:\n"
      "  takt soak share/demo/two_axes.yaml --hours 24 --jobs 2\n"
      "  takt soak share/demo/two_axes.yaml --seed 17 --part front --verbose");
}

}  // namespace takt
