#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>
#include <tuple>
#include <unistd.h>

#include "apps/takt/commands.hpp"
#include "apps/takt/live_arguments.hpp"

namespace {

/// Names of the subcommands of `app`.
std::string commands_of(const CLI::App& app) {
  std::string names;
  for (const CLI::App* verb : app.get_subcommands({})) names += ' ' + verb->get_name();
  return names;
}

/// CLI11 says of `takt frob` that a subcommand is missing. False: a word that is none was told.
bool commands_known(const CLI::App& app, int argc, char** argv) {
  const CLI::App* at = &app;
  std::string path = app.get_name();
  for (int i = 1; i < argc && !at->get_subcommands({}).empty(); ++i) {
    const std::string word = argv[i];
    if (word.starts_with('-')) return true;
    const auto verbs =
        at->get_subcommands([&word](const CLI::App* verb) { return verb->check_name(word); });
    if (verbs.empty()) {
      std::fprintf(stderr, "%s: no command '%s'; there are:%s\n", path.c_str(), word.c_str(),
                   commands_of(*at).c_str());
      return false;
    }
    path += ' ' + word;
    at = verbs.front();
  }
  return true;
}

/// Why not all of stdout has been written; empty: it has. The reason of a write that failed long
/// ago is that of one more.
std::string output_trouble() {
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
      "Examples:\n  takt plan lift.yaml            what taktd will do with a network file\n"
      "  takt simulate lift.yaml        try it in virtual time\n"
      "  takt status                    ask the running daemon\n"
      "Each command has a --help of its own. Exit codes: 0 good, 1 the answer is no, 2 wrong use\n"
      "or network file, 3 bus trouble, 4 a mandatory node is missing, 5 real-time limit broken.");
  int exit_code = 0;
  takt::add_audit(app, exit_code);
  takt::add_dump(app, exit_code);
  takt::add_eds(app, exit_code);
  takt::add_plan(app, exit_code);
  takt::add_sim(app, exit_code);
  takt::add_simulate(app, exit_code);
  takt::add_keys(app, exit_code);
  takt::add_record(app, exit_code);
  takt::add_replay(app, exit_code);
  takt::add_soak(app, exit_code);
  takt::add_status(app, exit_code);
  takt::add_top(app, exit_code);
  takt::add_timing(app, exit_code);
  takt::add_emcy(app, exit_code);
  takt::add_budget(app, exit_code);
  takt::add_export(app, exit_code);
  takt::add_import(app, exit_code);
  takt::add_learn(app, exit_code);
  takt::add_scan(app, exit_code);
  takt::add_doctor(app, exit_code);
  takt::add_sdo(app, exit_code);
  takt::add_nmt(app, exit_code);
  takt::add_lss(app, exit_code);
  takt::add_param(app, exit_code);
  if (!commands_known(app, argc, argv)) return 2;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  int exit_code = 2;
  std::string trouble;
  try {
    exit_code = run(argc, argv);
  } catch (const std::exception& error) {
    trouble = error.what();
  }
  if (const std::string lost = output_trouble(); !lost.empty()) return takt::complain(lost, 1);
  return trouble.empty() ? exit_code : takt::complain(trouble, exit_code);
}
