#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/duration_option.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/takt/log/file_log.hpp"
#include "apps/takt/log/live_log.hpp"

namespace takt {
namespace logging {
namespace {

constexpr const char* help =
    R"(SIGNAL is node.name, or a pattern with * and ?. Without one, all signals are recorded.
The ending of FILE selects the format: .csv for tables, .mcap for Foxglove, Lichtblick and
PlotJuggler. `-o -` writes CSV to stdout. Values are in the units of the network file.

Examples:
  takt log -o run.mcap                          until Ctrl-C or the end of taktd
  takt log 'shoulder.*' -o run.csv --for 10s
  takt log shoulder.statusword -o -
  takt log --from trace.log --network lift.yaml -o trace.mcap
  takt log --from $(takt record) -o fault.mcap)";

struct LogOptions {
  LiveLogOptions live;
  FileLogOptions file;
  std::string bus;
};

int run(const LogOptions& options) {
  if (options.file.file.empty()) {
    if (!options.file.network.empty()) {
      throw Failure{"--network is for recordings: name one with --from FILE", exit_wrong_use};
    }
    LiveLogOptions live = options.live;
    live.live.bus_name = options.bus;
    log_live(live);
    return 0;
  }
  if (options.live.length) {
    throw Failure{"--for is for a running bus; a recording is converted as a whole",
                  exit_wrong_use};
  }
  FileLogOptions file = options.file;
  file.interface = options.bus;
  file.patterns = options.live.patterns;
  file.output = options.live.output;
  log_file(file);
  return 0;
}

}  // namespace
}  // namespace logging

void add_log(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<logging::LogOptions>(
      app, exit_code, "log", "records signals and events of a running bus as CSV or MCAP",
      logging::run);
  verb.add_option("SIGNAL", options.live.patterns, "node.name or pattern; default: all signals")
      ->type_name("NAME");
  verb.add_option("-o,--output", options.live.output, "file to write: .csv, .mcap, - for stdout")
      ->type_name("FILE")
      ->required();
  add_duration(verb, "--for", options.live.length, "end after this time");
  verb.add_option("--from", options.file.file,
                  "convert a recording of candump (-L) or of the black box; - for stdin")
      ->type_name("FILE");
  verb.add_option("--network", options.file.network, "with --from: network file of the recording")
      ->type_name("NET.yaml");
  verb.add_option("--bus-name,--bus", options.bus,
                  "name of the bus, if there are several; with --from: interface of the recording")
      ->type_name("NAME");
  verb.add_option("--lcm-url", options.live.live.lcm_url,
                  "LCM URL of the daemon; default: LCM_DEFAULT_URL")
      ->type_name("URL");
  add_key_options(verb, options.live.live.keys, options.live.live.check_images);
  verb.footer(logging::help);
}

}  // namespace takt
