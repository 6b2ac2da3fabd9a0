#include <CLI/CLI.hpp>
#include <chrono>
#include <map>
#include <string>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/commands.hpp"
#include "apps/command_line/known_words.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "eds_parser/table/boot_plan.hpp"
#include "master/linux/bus/frame_channel.hpp"

namespace takt {
namespace {

struct NmtOptions {
  LiveOptions live;
  std::string command;
  std::string node;
  std::string bus;
};

const std::map<std::string, NmtCommand> commands{{"start", NmtCommand::start},
                                                 {"stop", NmtCommand::stop},
                                                 {"preop", NmtCommand::enter_preoperational},
                                                 {"reset", NmtCommand::reset_node},
                                                 {"reset-comm", NmtCommand::reset_communication}};

int run_on_bus(const NmtOptions& options) {
  const auto id = parse_node_id(options.node);
  if (!id && options.node != "all") {
    return complain("'" + options.node + "' is not a node id 1..127 or all", 2);
  }
  FrameChannel channel = value_or_fail(FrameChannel::open(options.bus, BusMember::guest), 3);
  const std::uint8_t node = id ? id->value() : std::uint8_t{0};
  const Frame frame =
      make_frame(CobId::base(0), {static_cast<std::uint8_t>(commands.at(options.command)), node});
  if (!channel.send(frame)) throw Failure{"the frame could not be sent on " + options.bus};
  return 0;
}

/// Returns how long to wait for the answer. The daemon sends a command that ends the PDO exchange
/// only after it has stopped the axes in order.
std::chrono::seconds reply_limit(const std::string& command) {
  const bool after_axes = command == "stop" || command == "preop";
  return std::chrono::seconds{after_axes ? 65 : 3};  // `stop_timeout` is at most 60 s
}

int run(const NmtOptions& options) {
  if (!options.bus.empty()) return run_on_bus(options);
  DaemonClient daemon = DaemonClient::find(options.live);
  const auto listed = daemon.find_node(options.node);
  const auto id = parse_node_id(options.node);  // may be the node-ID of the master itself
  request_t request =
      make_request("nmt", !listed && id ? std::int16_t{id->value()} : daemon.node(options.node));
  request.nmt_command = static_cast<std::int16_t>(commands.at(options.command));
  daemon.demand(std::move(request), reply_limit(options.command));
  return 0;
}

}  // namespace

void add_nmt(CLI::App& app, int& exit_code) {
  auto [verb, options] =
      add_command<NmtOptions>(app, exit_code, "nmt", "starts, stops and resets nodes", run);
  verb.footer(
      "Before it sends stop or preop, the daemon stops the enabled axes of the nodes in order;\n"
      "takt nmt waits for this. The daemon sends the other commands at once. With --bus, takt nmt\n"
      "sends every command at once.\n\n"
      "Examples:\n  takt nmt reset 5\n  takt nmt preop all --bus-name lift\n"
      "  takt nmt start 5 --bus can0      needs no daemon");
  verb.add_option("COMMAND", options.command, "start, stop, preop, reset, reset-comm")
      ->required()
      ->check(one_of({"start", "stop", "preop", "reset", "reset-comm"}));
  verb.add_option("NODE", options.node, "node id (also the master's), name, or all")->required();
  add_bus(verb, options.bus, "work directly on can0 or unix:PATH, without a daemon")
      ->type_name("IFACE");
  add_live_options(verb, options.live);
}

}  // namespace takt
