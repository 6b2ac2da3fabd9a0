#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/json_text.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "apps/takt/live/pdo_table.hpp"
#include "apps/takt/live/screen.hpp"
#include "apps/takt/live/top_frame.hpp"
#include "master/lcm/channel_names.hpp"
#include "master/lcm/printable_text.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

constexpr Time first_limit = std::chrono::milliseconds{2500};
constexpr Time pdos_limit = std::chrono::milliseconds{1500};
constexpr Time settle =
    std::chrono::milliseconds{250};  // every bus sends a status within this time

nlohmann::json to_json(const node_status_t& node) {
  return {{"node_id", node.node_id},
          {"name", node.name},
          {"nmt_state", nmt_name(node.nmt_state)},
          {"boot", boot_name(node)},
          {"boot_state", node.boot_state},
          {"boot_step", node.boot_step},
          {"boot_steps", node.boot_steps},
          {"heartbeat_age_ms", node.heartbeat_age_ms},
          {"error_register", node.error_register},
          {"last_emcy", node.last_emcy},
          {"emcy_count", node.emcy_count},
          {"boot_count", node.boot_count},
          {"heartbeat_lost", node.heartbeat_lost},
          {"sdo_aborts", node.sdo_aborts},
          {"pdos_missing", node.pdos_missing},
          {"holder", node.holder},
          {"emcys", node.emcys}};
}

nlohmann::json to_json(const diagnosis_t& diagnosis) {
  return {{"sync_count", diagnosis.sync_count},
          {"nodes_not_ok", diagnosis.nodes_not_ok},
          {"state", bus_condition(diagnosis.state)},
          {"bus_off", diagnosis.bus_off != 0},
          {"warning_limit", diagnosis.warning_limit != 0},
          {"rx_queue_exceeded", diagnosis.rx_queue_exceeded != 0},
          {"tx_queue_exceeded", diagnosis.tx_queue_exceeded != 0},
          {"send_error", diagnosis.send_error != 0},
          {"sync_toggle", diagnosis.sync_toggle != 0},
          {"cycles_failed", diagnosis.cycles_failed},
          {"outputs_skipped", diagnosis.outputs_skipped},
          {"images_incomplete", diagnosis.images_incomplete},
          {"changed", diagnosis.changed != 0}};
}

nlohmann::json to_json(const sync_status_t& sync) {
  static constexpr const char* states[] = {"none", "made", "awaited", "locked", "lost"};
  return {{"state", states[std::clamp<int>(sync.state, 0, 4)]},
          {"source", sync.source},
          {"node_id", sync.node_id},
          {"period_ns", sync.period_ns},
          {"declared_ns", sync.declared_ns},
          {"timeout_ns", sync.timeout_ns},
          {"syncs", sync.syncs},
          {"losses", sync.losses},
          {"text", sync.text}};
}

nlohmann::json to_json(const status_t& status) {
  nlohmann::json nodes = nlohmann::json::array();
  for (const node_status_t& node : status.nodes) nodes.push_back(to_json(node));
  return {{"bus", status.bus},
          {"interface", status.interface},
          {"bitrate", status.bitrate},
          {"realtime", status.realtime},
          {"session", status.session},
          {"cycle", status.cycle},
          {"period_ns", status.period_ns},
          {"cycles_missed", status.cycles_missed},
          {"cycles_late", status.cycles_late},
          {"image_overruns", status.image_overruns},
          {"event_overruns", status.event_overruns},
          {"frames_received", status.frames_received},
          {"frames_sent", status.frames_sent},
          {"send_failures", status.send_failures},
          {"receive_overruns", status.receive_overruns},
          {"error_frames", status.error_frames},
          {"commands_taken", status.commands_taken},
          {"commands_refused", status.commands_refused},
          {"bus_load", status.bus_load},
          {"bus_state", status.bus_state},
          {"tx_errors", status.tx_errors},
          {"rx_errors", status.rx_errors},
          {"stop", stop_name(status.stop)},
          {"stop_text", status.stop_text},
          {"diagnosis", to_json(status.diagnosis)},
          {"nodes", std::move(nodes)}};
}

struct StatusOptions {
  LiveOptions live;
  bool pdos = false;
};

void print(const std::vector<const BusView*>& buses) {
  const bool terminal = ::isatty(STDOUT_FILENO) != 0;
  const std::size_t width = terminal ? Screen::size().columns : 160;
  for (const BusView* const bus : buses) {
    for (const Line& line : status_lines(*bus)) {
      std::printf("%s\n", line.render(width, terminal).c_str());
    }
    if (bus->pdos()) {
      for (const std::string& line : pdo_lines(*bus->pdos(), *bus->status())) {
        std::printf("%s\n", printable_text(line).c_str());
      }
    }
  }
}

void print_json(const std::vector<const BusView*>& buses) {
  nlohmann::json all = nlohmann::json::array();
  for (const BusView* const bus : buses) {
    all.push_back(to_json(*bus->status()));
    if (bus->sync()) all.back()["sync"] = to_json(*bus->sync());
    if (bus->pdos()) all.back()["pdos"] = pdos_json(*bus->pdos());
  }
  const nlohmann::json document{{"buses", std::move(all)}};
  std::puts(json_text(document, 1).c_str());
}

int run(const StatusOptions& all) {
  const LiveOptions& options = all.live;
  std::vector<std::string> channels{any_bus("STATUS"), any_bus("SYNC")};
  if (all.pdos) channels.push_back(any_bus("PDOS"));
  auto lcm = open_live(options, channels);
  if (!lcm) return complain(lcm.error().sentence, lcm.error().code);
  BusViews views;
  listen(*lcm, views, monotonic_now() + first_limit,
         [&] { return !chosen(views, options.bus_name).empty(); });
  if (chosen(views, options.bus_name).empty()) {
    const LiveError error = no_bus(views, *lcm, options.bus_name);
    return complain(error.sentence, error.code);
  }
  listen(*lcm, views, monotonic_now() + settle, [] { return false; });
  if (all.pdos) {
    listen(*lcm, views, monotonic_now() + pdos_limit, [&] {
      return std::ranges::all_of(chosen(views, options.bus_name),
                                 [](const BusView* bus) { return bus->pdos().has_value(); });
    });
  }
  const auto buses = chosen(views, options.bus_name);
  options.json ? print_json(buses) : print(buses);
  std::fflush(stdout);
  const auto two = two_daemons(buses);
  return two ? complain(two->sentence, two->code) : 0;
}

}  // namespace

void add_status(CLI::App& app, int& exit_code) {
  auto* verb = app.add_subcommand(
      "status", "prints the state of the running daemon, of its bus and its nodes");
  verb->footer(
      "Examples:\n  takt status\n  takt status --pdos\n  takt status --json --bus-name lift");
  auto options = std::make_shared<StatusOptions>();
  verb->add_flag("--pdos", options->pdos,
                 "also print each PDO: age, count, missing, late, wrong length");
  add_live_options(*verb, options->live);
  verb->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace takt
