#pragma once
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

namespace takt {

/// A verb of the tool, and the options that its arguments fill.
template <class Options>
struct AddedCommand {
  CLI::App& verb;
  Options& options;
};

/// Adds a verb that calls `run` with its options and keeps the exit code.
template <class Options>
AddedCommand<Options> add_command(CLI::App& app, int& exit_code, const std::string& name,
                                  const std::string& what, int (*run)(const Options&)) {
  auto* verb = app.add_subcommand(name, what);
  const auto options = std::make_shared<Options>();
  verb->callback([options, run, &exit_code] { exit_code = run(*options); });
  return {*verb, *options};
}

/// Adds one verb of the tool to the command line. If the user chooses the verb, it runs and sets
/// the exit code (share/doc/command_line.md).
using AddCommand = void (*)(CLI::App& app, int& exit_code);

void add_audit(CLI::App& app, int& exit_code);
void add_budget(CLI::App& app, int& exit_code);
void add_complete(CLI::App& app, int& exit_code);
void add_demo(CLI::App& app, int& exit_code);
void add_doctor(CLI::App& app, int& exit_code);
void add_dump(CLI::App& app, int& exit_code);
void add_emcy(CLI::App& app, int& exit_code);
void add_eds(CLI::App& app, int& exit_code);
void add_export(CLI::App& app, int& exit_code);
void add_import(CLI::App& app, int& exit_code);
void add_init(CLI::App& app, int& exit_code);
void add_keys(CLI::App& app, int& exit_code);
void add_learn(CLI::App& app, int& exit_code);
void add_param(CLI::App& app, int& exit_code);
void add_plan(CLI::App& app, int& exit_code);
void add_sim(CLI::App& app, int& exit_code);
void add_simulate(CLI::App& app, int& exit_code);
void add_log(CLI::App& app, int& exit_code);
void add_lss(CLI::App& app, int& exit_code);
void add_nmt(CLI::App& app, int& exit_code);
void add_od(CLI::App& app, int& exit_code);
void add_record(CLI::App& app, int& exit_code);
void add_reference(CLI::App& app, int& exit_code);
void add_replay(CLI::App& app, int& exit_code);
void add_scan(CLI::App& app, int& exit_code);
void add_sdo(CLI::App& app, int& exit_code);
void add_smooth(CLI::App& app, int& exit_code);
void add_soak(CLI::App& app, int& exit_code);
void add_spy(CLI::App& app, int& exit_code);
void add_status(CLI::App& app, int& exit_code);
void add_timing(CLI::App& app, int& exit_code);
void add_top(CLI::App& app, int& exit_code);
void add_trajectory(CLI::App& app, int& exit_code);

/// The verbs of `takt eds` that have separate source files.
void add_eds_dcf(CLI::App& eds, int& exit_code);
void add_eds_cdcf(CLI::App& eds, int& exit_code);
void add_eds_fix(CLI::App& eds, int& exit_code);

}  // namespace takt
