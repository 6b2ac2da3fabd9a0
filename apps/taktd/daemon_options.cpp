#include "apps/taktd/daemon_options.hpp"

#include <CLI/CLI.hpp>
#include <map>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/duration.hpp"
#include "apps/command_line/known_words.hpp"
#include "eds_parser/lcm/lcm_url.hpp"

namespace takt {
namespace {

constexpr const char* description =
    "taktd - CANopen master: boots the devices of a network file, produces SYNC, and exchanges\n"
    "the process image with applications over LCM.";

constexpr const char* footer = R"(
Examples:
  taktd lift.yaml                      on the `interface:` of the file
  taktd lift.yaml --bus vcan0          on another interface
  taktd lift.yaml --bus sim --for 10s  simulated bus and devices, no hardware needed
  taktd lift.yaml --check              compile only, use no bus; exit code 1: frames may be too late
  taktd lift.yaml --observe            listen only: send nothing
  taktd lift.yaml --gateway unix:/run/takt.sock       ASCII gateway (CiA 309-3)
  taktd lift.yaml --black-box /var/lib/takt           recordings of faults, for takt replay

Live views: takt top, takt status. SIGTERM, SIGINT (Ctrl-C) or SIGHUP (the terminal closes)
starts the ordered stop: it brings the axes to rest and the nodes to pre-operational, and ends
SYNC. A second signal stops taktd at once.

Exit codes: 0 good, 1 refused (real time under --rt enforce), 2 wrong use or network file,
3 bus error, 4 a mandatory node is missing or failed its boot, 5 a real-time limit was
exceeded, 6 the ordered stop was not confirmed.)";

const std::map<std::string, RtMode> rt_modes{
    {"enforce", RtMode::enforce}, {"try", RtMode::attempt}, {"off", RtMode::off}};

/// Returns the reason why LCM does not take this URL. The reason is empty if LCM takes the URL, or
/// if no URL is given.
std::string lcm_url_error(const std::string& text) {
  const auto url = parse_lcm_url(text);
  return url || text.empty() ? "" : url.error();
}

}  // namespace

std::expected<DaemonOptions, int> read_command_line(int argc, char** argv) {
  CLI::App app{description, "taktd"};
  app.footer(footer);
  app.set_version_flag("--version", "taktd " TAKT_VERSION);
  app.get_formatter()->column_width(30);
  DaemonOptions options;
  std::string rt;
  std::string run_for;
  int typed = 0;  // 1 for --typed, -1 for --no-typed, 0 for neither
  app.add_option("NET.yaml", options.network_file, "network file")->required();
  add_bus(app, options.bus, "can0, vcan0 ...; unix:PATH; sim")->type_name("IFACE");
  app.add_option("--rt", rt,
                 "enforce: refuse to start without real time; try: report what is missing; off")
      ->check(one_of({"enforce", "try", "off"}))
      ->type_name("MODE");
  app.add_option("--lcm-url", options.lcm_url,
                 "use this URL, not LCM_DEFAULT_URL and `lcm: {url, broker}` of the file")
      ->check(lcm_url_error)
      ->type_name("URL");
  app.add_option("--for", run_for, "start the ordered stop after this time: 10s, 500ms, 2min")
      ->check(duration_error)
      ->type_name("TIME");
  app.add_option("--events", options.events_file, "append events as JSON, one object a line")
      ->type_name("FILE");
  app.add_option("--gateway", options.gateway,
                 "serve text commands of CiA 309-3: unix:PATH, or tcp:PORT on loopback")
      ->type_name("WHERE");
  app.add_option("--black-box", options.black_box,
                 "record frames and decisions; write them here after a fault or SIGUSR1")
      ->type_name("DIR");
  app.add_flag("--motions,!--no-motions", options.motions,
               "run the motions that applications command (default), or refuse them");
  app.add_flag("--typed,!--no-typed", typed,
               "use BUS_NODE_STATE and BUS_NODE_COMMAND in the types of `takt export lcm`");
  app.add_flag("--check", options.check, "check the network file, print a summary, use no bus");
  app.add_flag("--observe", options.observe, "listen only: no NMT, no SDO, no SYNC, no outputs");
  if (const auto exit_code = parse_arguments(app, argc, argv)) return std::unexpected{*exit_code};
  if (!rt.empty()) options.rt = rt_modes.at(rt);
  if (typed != 0) options.typed = typed > 0;
  if (!run_for.empty()) options.run_for = *parse_duration(run_for);
  return options;
}

}  // namespace takt
