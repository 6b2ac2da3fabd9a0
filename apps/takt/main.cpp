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

struct Command {
  const char* group;  ///< heading of the group in the help text; empty: not listed
  AddCommand add;
};

constexpr const char* devices = "Device files and network files";
constexpr const char* analysis = "Before the bus runs";
constexpr const char* running = "A running daemon";
constexpr const char* on_the_bus = "Devices on the bus, with and without a daemon";
constexpr const char* recordings = "Frames and recordings";

/// The commands in the order of the help text.
constexpr Command commands[]{
    {devices, add_plan},      {devices, add_reference},   {devices, add_eds},
    {devices, add_init},      {devices, add_import},      {devices, add_learn},
    {devices, add_export},    {devices, add_keys},        {analysis, add_budget},
    {analysis, add_simulate}, {analysis, add_sim},        {analysis, add_demo},
    {analysis, add_soak},     {analysis, add_trajectory}, {analysis, add_doctor},
    {running, add_status},    {running, add_top},         {running, add_timing},
    {running, add_emcy},      {running, add_spy},         {running, add_record},
    {on_the_bus, add_scan},   {on_the_bus, add_sdo},      {on_the_bus, add_od},
    {on_the_bus, add_nmt},    {on_the_bus, add_lss},      {on_the_bus, add_param},
    {on_the_bus, add_audit},  {recordings, add_log},      {recordings, add_dump},
    {recordings, add_smooth}, {recordings, add_replay},   {"", add_complete},
};

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
      "`takt help plan` prints the help of one command, as `takt plan --help` does.\n\n"
      "Exit codes: 0 good, 1 a negative result, 2 wrong use or\n"
      "invalid network file, 3 bus error, 4 a mandatory node is missing, 5 a real-time limit\n"
      "was exceeded, 6 the ordered stop was not confirmed.");
  int exit_code = 0;
  for (const auto& [group, add] : commands) {
    add(app, exit_code);
    app.get_subcommands({}).back()->group(group);
  }
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
