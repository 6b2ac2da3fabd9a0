#include <CLI/CLI.hpp>
#include <filesystem>
#include <system_error>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/duration_option.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/takt/demo/demo_files.hpp"
#include "apps/takt/demo/demo_run.hpp"

namespace takt {
namespace {

int run(const DemoOptions& options) {
  if (options.run_for && *options.run_for < shortest_demo) {
    throw Failure{
        "--for needs at least 4s: the axes move to a point in 1.85 s, and one "
        "period of their sine takes 2 s",
        exit_wrong_use};
  }
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw Failure{"/proc/self/exe: " + error.message(), exit_wrong_use};
  return DemoRun{value_or_fail(find_demo_files(program), exit_wrong_use), options}.run();
}

}  // namespace

void add_demo(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<DemoOptions>(
      app, exit_code, "demo", "runs a demo machine on a simulated bus and moves its axes", run);
  verb.footer(
      "The demo machine has two CiA 402 drives and an I/O module. taktd simulates them, and\n"
      "takt-move moves them until Ctrl-C. No CAN interface is used, and nothing real moves.\n\n"
      "Examples:\n"
      "  takt demo            move the axes, and show what to look at from a second terminal\n"
      "  takt demo --for 10s  the same for 10 s\n"
      "  takt demo --still    leave the axes to takt-jog, Python or a program of your own\n\n"
      "Exit codes: 0 the axes followed and taktd stopped in order, 1 the axes did not follow,\n"
      "2 a file of the demo is missing, else that of taktd.");
  add_duration(verb, "--for", options.run_for, "end after this time: 10s, 2min; at least 4s");
  verb.add_flag("--still", options.still, "do not move the axes");
}

}  // namespace takt
