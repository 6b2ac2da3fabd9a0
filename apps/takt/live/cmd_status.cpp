#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/json_text.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "apps/takt/live/screen.hpp"
#include "apps/takt/live/text/node_words.hpp"
#include "apps/takt/live/view/axis_view.hpp"
#include "apps/takt/live/view/pdo_table.hpp"
#include "apps/takt/live/view/top_frame.hpp"
#include "master/linux/clock.hpp"

namespace takt {

// The fields that the JSON document takes as they are.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(node_status_t, node_id, name, boot_state, boot_step, boot_steps,
                                   heartbeat_age_ms, error_register, last_emcy, emcy_count,
                                   boot_count, heartbeat_lost, sdo_aborts, pdos_missing, holder,
                                   emcys)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(diagnosis_t, sync_count, nodes_not_ok, cycles_failed,
                                   outputs_skipped, images_incomplete)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(sync_status_t, source, node_id, period_ns, declared_ns,
                                   timeout_ns, syncs, losses, text)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(status_t, bus, interface, bitrate, realtime, session, cycle,
                                   period_ns, cycles_missed, cycles_late, image_overruns,
                                   event_overruns, frames_received, frames_sent, send_failures,
                                   receive_overruns, error_frames, commands_taken, commands_refused,
                                   bus_load, bus_state, tx_errors, rx_errors, stop_text)

namespace {

/// Longest wait: the layout comes once a second, the status of the PDOs twice.
constexpr Time wait_limit = std::chrono::milliseconds{1500};

/// Returns true if an image has come, or if the bus does not run and may therefore send no image.
bool has_image(const BusView& bus) {
  return bus.status()->diagnosis.state != 0 || !bus.values().empty();
}

nlohmann::json json_of(const node_status_t& node) {
  nlohmann::json json = node;
  json["nmt_state"] = nmt_name(node.nmt_state);
  json["boot"] = boot_name(node);
  return json;
}

nlohmann::json json_of(const diagnosis_t& diagnosis) {
  nlohmann::json json = diagnosis;
  json["state"] = bus_condition(diagnosis.state);
  json["bus_off"] = diagnosis.bus_off != 0;
  json["warning_limit"] = diagnosis.warning_limit != 0;
  json["rx_queue_exceeded"] = diagnosis.rx_queue_exceeded != 0;
  json["tx_queue_exceeded"] = diagnosis.tx_queue_exceeded != 0;
  json["send_error"] = diagnosis.send_error != 0;
  json["sync_toggle"] = diagnosis.sync_toggle != 0;
  json["changed"] = diagnosis.changed != 0;
  return json;
}

nlohmann::json json_of(const sync_status_t& sync) {
  static constexpr const char* states[] = {"none", "made", "awaited", "locked", "lost"};
  nlohmann::json json = sync;
  json["state"] = states[std::clamp<int>(sync.state, 0, 4)];
  return json;
}

nlohmann::json json_of(const status_t& status) {
  nlohmann::json json = status;
  json["stop"] = stop_name(status.stop);
  json["diagnosis"] = json_of(status.diagnosis);
  json["nodes"] = nlohmann::json::array();
  for (const node_status_t& node : status.nodes) json["nodes"].push_back(json_of(node));
  return json;
}

struct StatusOptions {
  LiveOptions live;
  bool pdos = false;
};

void print(const std::vector<const BusView*>& buses) {
  const std::size_t width = output_width();
  for (const BusView* const bus : buses) {
    print_lines(status_lines(*bus, width), width);
    if (bus->pdos()) print_lines(pdo_table(*bus->pdos(), *bus->status(), width).all(), width);
  }
}

/// Returns the words of the axes of a bus; an empty list before its first image.
nlohmann::json axes_json(const BusView& bus) {
  const auto word = [](const std::optional<DriveWord>& of) {
    if (!of) return nlohmann::json{};
    return nlohmann::json{{"value", of->value}, {"text", of->text}};
  };
  nlohmann::json axes = nlohmann::json::array();
  for (const AxisView& axis : axes_of(bus)) {
    axes.push_back({{"axis", axis.name},
                    {"node_id", axis.node},
                    {"state", axis.state.text},
                    {"mode", axis.mode},
                    {"statusword", word(axis.statusword)},
                    {"controlword", word(axis.controlword)}});
  }
  return axes;
}

void print_json(const std::vector<const BusView*>& buses) {
  nlohmann::json all = nlohmann::json::array();
  for (const BusView* const bus : buses) {
    all.push_back(json_of(*bus->status()));
    if (bus->sync()) all.back()["sync"] = json_of(*bus->sync());
    if (bus->pdos()) all.back()["pdos"] = pdos_json(*bus->pdos());
    all.back()["axes"] = axes_json(*bus);
  }
  const nlohmann::json document{{"buses", std::move(all)}};
  std::puts(json_text(document, 1).c_str());
}

int run(const StatusOptions& all) {
  const LiveOptions& options = all.live;
  std::vector<std::string_view> channels{"STATUS", "SYNC", "LAYOUT", "IMAGE", "SPEED_AXES"};
  if (all.pdos) channels.push_back("PDOS");
  LcmClient lcm = open_live(options, channels);
  BusViews views;
  std::vector<const BusView*> buses = find_buses(lcm, views, options.bus_name);
  listen(lcm, views, monotonic_now() + wait_limit, [&] {
    buses = chosen(views, options.bus_name);
    return std::ranges::all_of(buses, [&](const BusView* bus) {
      return has_image(*bus) && (!all.pdos || bus->pdos().has_value());
    });
  });
  options.json ? print_json(buses) : print(buses);
  std::fflush(stdout);
  refuse_two_daemons(buses);
  return 0;
}

}  // namespace

void add_status(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<StatusOptions>(
      app, exit_code, "status", "prints the state of the running daemon, of its bus and its nodes",
      run);
  verb.footer(
      "Examples:\n  takt status\n  takt status --pdos\n  takt status --json --bus-name lift");
  verb.add_flag("--pdos", options.pdos,
                "also print each PDO: age, count, missing, late, wrong length");
  add_live_options(verb, options.live);
}

}  // namespace takt
