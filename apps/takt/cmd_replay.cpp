#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/print/plan/plan_fingerprint.hpp"
#include "master/black_box/replay.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

constexpr const char* help =
    R"(FILE is any of the three files of a recording: NAME.log (frames, as `candump -L` writes them),
NAME.events.json (decisions), NAME.journal (times). takt reads the frames from NAME.log: change a
frame there to see where the master would have decided otherwise.

Exit codes: 0 the same decisions, 1 a difference (takt prints the first one), 2 the file is not a
recording, or takt can't replay it.

Examples:
  takt replay lift-20260314T150926.log
  takt replay lift-20260314T150926.log --network lift.yaml --quiet)";

struct ReplayOptions {
  std::string file;
  std::string network;
  bool quiet = false;
};

void print(const Decision& decision) {
  fmt::print("{:>14.6f}  {}\n", 1e-9 * static_cast<double>(decision.time),
             printable_text(decision.text));
}

/// Returns the network file: the one of the options, otherwise the path in the recording, otherwise
/// a file of that name beside the recording.
std::string find_network(const ReplayOptions& options, const RecordingHead& head) {
  if (!options.network.empty()) return options.network;
  std::error_code error;
  if (std::filesystem::exists(head.network, error)) return head.network;
  const auto beside = std::filesystem::path{options.file}.parent_path() /
                      std::filesystem::path{head.network}.filename();
  return std::filesystem::exists(beside, error) ? beside.string() : head.network;
}

int run(const ReplayOptions& options) {
  const auto recording = value_or_fail(read_recording(options.file), exit_wrong_use);
  if (recording.fault) throw Failure{options.file + ": " + *recording.fault, exit_wrong_use};
  const std::string file = find_network(options, recording.head);
  LoadedNetwork network = load_network(file);
  if (print_findings(network.findings, Severity::error)) {
    if (!options.network.empty()) return exit_wrong_use;
    throw Failure{"the recording needs the network file " + recording.head.network +
                      "; give it with --network",
                  exit_wrong_use};
  }
  if (plan_fingerprint(network.plan) != recording.head.fingerprint) {
    complain(file + " or its EDS files have changed since the recording was made", 0);
  }
  network.plan.name = recording.head.bus;
  network.plan.interface = recording.head.interface;
  const ReplayOutcome outcome = replay(network.plan, recording, [&](const Decision& decision) {
    if (!options.quiet) print(decision);
  });
  fmt::print("{}: {} cycles replayed, {} of {} decisions as recorded\n",
             printable_text(recording.head.reason), outcome.cycles, outcome.decisions,
             recording.decisions.size());
  if (!outcome.difference) return 0;
  fmt::print("first difference: {}\n", printable_lines(*outcome.difference));
  return 1;
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
  auto [command, options] = add_command<ReplayOptions>(
      app, exit_code, "replay",
      "runs a recording of the black box again and compares the decisions", run);
  command.add_option("FILE", options.file, "recording of `taktd --black-box`")->required();
  command.add_option("--network", options.network,
                     "network file to use instead of that of the recording");
  command.add_flag("--quiet", options.quiet, "print only the result");
  command.footer(help);
}

}  // namespace takt
