#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>
#include <tuple>
#include <unistd.h>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/command_line/live_arguments.hpp"

namespace {

using namespace takt;

/// The commands in the order of the help text.
constexpr AddCommand commands[]{
    add_audit,  add_dump,      add_eds,    add_plan,   add_sim,        add_simulate, add_keys,
    add_record, add_reference, add_replay, add_soak,   add_status,     add_top,      add_timing,
    add_emcy,   add_budget,    add_export, add_import, add_learn,      add_scan,     add_doctor,
    add_sdo,    add_nmt,       add_lss,    add_param,  add_trajectory, add_smooth};

/// Returns the reason why stdout could not be written completely, or an empty string. If a write
/// failed earlier, its errno is lost, so one more write finds the reason.
std::string output_error() {
  const bool before = std::cout.good() && std::ferror(stdout) == 0;
  errno = 0;
  std::cout.flush();
  if (std::fflush(stdout) == 0 && before && std::cout.good()) return {};
  if (errno == 0) std::ignore = ::write(STDOUT_FILENO, "\n", 1);
  const std::string reason = errno == 0 ? "" : std::string{": "} + std::strerror(errno);
  return "can't write to stdout" + reason;
}

int run(int argc, char** argv) {
  CLI::App app{"takt - CANopen from the command line", "takt"};
  app.require_subcommand(1);
  app.set_version_flag("--version", "takt " TAKT_VERSION);
  app.get_formatter()->column_width(34);
  app.footer(
      "Examples:\n"
      "  takt plan lift.yaml            print what taktd will do with a network file\n"
      "  takt simulate lift.yaml        run a network file in virtual time\n"
      "  takt status                    ask the running daemon\n"
      "Each command has its own --help. Exit codes: 0 good, 1 a negative result, 2 wrong use or\n"
      "invalid network file, 3 bus error, 4 a mandatory node is missing, 5 a real-time limit\n"
      "was broken, 6 the ordered stop was not confirmed.");
  int exit_code = 0;
  for (const AddCommand add : commands) add(app, exit_code);
  try {
    const auto ended = parse_arguments(app, argc, argv);  // runs the command, too
    return ended.value_or(exit_code);
  } catch (const Failure& failure) {
    return complain(failure.what(), failure.code);
  }
}

}  // namespace

int main(int argc, char** argv) {
  int exit_code = 2;
  std::string failure;
  try {
    exit_code = run(argc, argv);
  } catch (const std::exception& error) {
    failure = error.what();
  }
  if (const std::string lost = output_error(); !lost.empty()) return complain(lost, 1);
  return failure.empty() ? exit_code : complain(failure, exit_code);
}
