#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/duration.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/simulate/fault_file.hpp"
#include "apps/takt/simulate/outcome_report.hpp"
#include "apps/takt/simulate/simulation.hpp"

namespace takt {
namespace {

struct SimulateArguments {
  std::string network;
  std::string run_for = "10s";
  std::string faults;
  std::string jitter = "0us";
  SimulationOptions simulation;
  bool json = false;
};

int run(const SimulateArguments& arguments) {
  const LoadedNetwork network = load_network(arguments.network);
  if (print_findings(network.findings)) return 2;
  SimulationOptions options = arguments.simulation;
  if (!arguments.faults.empty()) {
    FaultFile file = read_fault_file(arguments.faults, network.plan, options.applications);
    if (print_findings(file.findings)) return 2;
    options.faults = std::move(file.faults);
    options.programs = std::move(file.programs);
    options.motions = std::move(file.motions);
    if (options.move && !options.motions.empty()) {
      throw Failure{"--move excludes `motions:` in " + arguments.faults, exit_wrong_use};
    }
  }
  options.duration = *parse_duration(arguments.run_for);
  options.wake_jitter = *parse_duration(arguments.jitter);

  const auto start = std::chrono::steady_clock::now();
  const SimulationOutcome outcome = simulate(network, options);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  if (arguments.json) {
    print_json(std::cout, outcome);
  } else {
    print_text(std::cout, outcome);
  }
  const double simulated = std::chrono::duration<double>(outcome.simulated).count();
  std::cerr << "simulated " << simulated << " s in " << took.count()
            << " s: " << static_cast<long>(simulated / took.count()) << " times real time\n";
  return exit_code_of(outcome);
}

}  // namespace

void add_simulate(CLI::App& app, int& exit_code) {
  auto [command, arguments] = add_command<SimulateArguments>(
      app, exit_code, "simulate", "runs the master and its devices in virtual time", run);
  command.add_option("NET.yaml", arguments.network, "network file")->required();
  command.add_option("--for", arguments.run_for, "simulated time until the ordered stop")
      ->check(duration_error)
      ->capture_default_str();
  add_number(command, "--seed", arguments.simulation.seed, "seed; equal seeds give equal runs")
      ->capture_default_str();
  command.add_option("--faults", arguments.faults,
                     "file that lists faults, and motions of programs, with their times (YAML)");
  auto* move = command.add_flag("--move", arguments.simulation.move,
                                "move all CiA 402 axes with a built-in sine, without application");
  add_number(command, "--applications", arguments.simulation.applications,
             "run the whole taktd, and this many programs that move the axes")
      ->check(CLI::Range(std::size_t{1}, most_applications))
      ->excludes(move);
  command
      .add_option("--jitter", arguments.jitter,
                  "longest delay of each wake-up of the simulated bus thread")
      ->check(duration_error)
      ->capture_default_str();
  command.add_option("--candump", arguments.simulation.candump,
                     "write all frames to this file, as candump -L does");
  command.add_flag("--json", arguments.json,
                   "print one JSON document, which is equal for equal seeds");
  command.footer(
      "Faults: a list under `faults:`, each {kind, node, at, for ...}. Kinds: loss, duplicate,\n"
      "error_frames (probability), delay (time), babble (cob_id, data, time), power_off, drift\n"
      "(ppm), mute_sdo (object), slow_sdo (time), refuse_object and refuse_write (object,\n"
      "abort_code), ignore_write (object), override_value (object, value), fixed_mapping,\n"
      "late_bootup and bootup_storm (time), no_bootup, self_start, no_start, preop_only,\n"
      "no_heartbeat, no_guarding, stuck_toggle, mute_pdo, device_error (emcy_code), lss_silent,\n"
      "lss_no_store, reset, bus_off, stall_master, interface_down. With --applications also\n"
      "stall_front, kill_master, slow_messages (time), stall_application, slow_application\n"
      "(time), kill_application, end_application, second_sender (these five also take\n"
      "application), replay, forge_command, forge_image and damage_messages (time).\n"
      "share/doc/faults.md has an example of each kind.\n"
      "Motions: a list under `motions:`, each {kind, at, program, axes ...}. Kinds: enable, "
      "reset,\n"
      "move (to), move_by (by), jog (velocity), gear (leader), stream (points), stop, home,\n"
      "disable, kill. `expect` says how an entry is to end; if one ends otherwise, the exit code\n"
      "is 1. share/doc/simulation.md has their keys.\n\n"
      "Example:\n"
      "  takt simulate share/demo/two_axes.yaml --for 100s --move\n"
      "  takt simulate share/demo/two_axes.yaml --applications 2 --faults crash.yaml\n"
      "  takt simulate share/demo/two_axes.yaml --faults share/demo/motions/two_axes.yaml --for "
      "20s\n"
      "  takt simulate lift.yaml --for 1h --seed 7 --faults bad_day.yaml --json");
}

}  // namespace takt
