#include <CLI/CLI.hpp>
#include <iostream>
#include <unistd.h>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/commands.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/audit/ask_devices.hpp"
#include "apps/takt/audit/audit_report.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "apps/takt/service/sdo_direct.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt {
namespace {

using std::chrono::milliseconds;

struct Arguments {
  std::string network;
  LiveOptions live;
  std::string bus;
  bool through_daemon = false;
  int timeout_ms = 500;
};

ReadObject on_the_bus(const Arguments& arguments, std::optional<LiveError>& trouble) {
  return [&arguments, &trouble](
             NodeId node, ObjectKey key) -> std::expected<std::vector<std::byte>, UnreadObject> {
    SdoDirect direct{arguments.bus, node, milliseconds{arguments.timeout_ms}};
    auto value = direct.upload(key);
    if (value) return std::move(*value);
    if (value.error().code == 3) trouble = value.error();
    return std::unexpected{UnreadObject{value.error().abort_code, value.error().sentence}};
  };
}

ReadObject by_daemon(DaemonClient& daemon, int timeout_ms, std::optional<LiveError>& trouble) {
  return [&daemon, timeout_ms, &trouble](
             NodeId node, ObjectKey key) -> std::expected<std::vector<std::byte>, UnreadObject> {
    request_t request{};
    request.service = "sdo_upload";
    request.node_id = node.value();
    request.index = key.index;
    request.sub = key.sub;
    request.timeout_ms = timeout_ms;
    const auto reply =
        daemon.ask(std::move(request), milliseconds{timeout_ms} * 10 + std::chrono::seconds{2});
    if (!reply) {
      trouble = reply.error();
      return std::unexpected{UnreadObject{0, reply.error().sentence}};
    }
    if (reply->good == 0) {
      return std::unexpected{
          UnreadObject{static_cast<std::uint32_t>(reply->abort_code), reply->text}};
    }
    const auto bytes = std::as_bytes(std::span{reply->data});
    return std::vector<std::byte>{bytes.begin(), bytes.end()};
  };
}

/// Asks every device. Returns an error if no device answered. `trouble` is set by `read` if the bus
/// cannot be used; this ends the questions.
std::optional<LiveError> ask(const LoadedNetwork& network, std::vector<DeviceValues>& values,
                             const ReadObject& read, const std::optional<LiveError>& trouble) {
  bool any = false;
  for (std::size_t i = 0; i < values.size() && !trouble; ++i) {
    any |= ask_device(network.plan.nodes[i].id, values[i], read);
  }
  if (trouble || any || values.empty()) return trouble;
  return LiveError{"no device of '" + network.plan.name + "' answers", 3};
}

std::optional<LiveError> ask(const Arguments& arguments, const LoadedNetwork& network,
                             std::vector<DeviceValues>& values) {
  std::optional<LiveError> trouble;
  if (!arguments.bus.empty()) {
    return ask(network, values, on_the_bus(arguments, trouble), trouble);
  }
  LiveOptions live = arguments.live;
  if (live.bus_name.empty()) live.bus_name = network.plan.name;
  auto daemon = DaemonClient::find(live);
  if (!daemon) return daemon.error();
  return ask(network, values, by_daemon(*daemon, arguments.timeout_ms, trouble), trouble);
}

int run(const Arguments& arguments) {
  const LoadedNetwork network = load_network(arguments.network);
  for (const Finding& finding : network.findings) {
    if (finding.severity != Severity::note) std::cerr << finding_text(finding) << '\n';
  }
  if (has_error(network.findings)) return 2;
  std::vector<DeviceValues> values;
  for (std::size_t i = 0; i < network.plan.nodes.size(); ++i) {
    values.emplace_back(network.plan.nodes[i], network.devices[i]);
  }
  const bool asks = !arguments.bus.empty() || arguments.through_daemon;
  if (asks) {
    const auto trouble = ask(arguments, network, values);
    if (trouble) return complain(trouble->sentence, trouble->code);
  }
  Audit result = audit(network.plan, values);
  result.asked = asks;
  if (arguments.live.json) {
    print_audit_json(std::cout, result);
  } else {
    print_audit(std::cout, result, ::isatty(STDOUT_FILENO) != 0 ? Colour::ansi : Colour::none);
  }
  return result.goes_on() ? 1 : 0;
}

}  // namespace

void add_audit(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  auto* command = app.add_subcommand(
      "audit", "tells what devices do if the master, the cable or the bus fails");
  command->add_option("NET", arguments->network, "network file (YAML, also a bus.yml)")->required();
  add_bus(*command, arguments->bus, "ask the devices on this bus directly; stop the daemon first")
      ->type_name("IFACE");
  command->add_flag("--live", arguments->through_daemon, "ask the devices through the daemon");
  add_number(*command, "--timeout", arguments->timeout_ms, "longest wait for each answer, ms")
      ->check(CLI::Range(1, 60'000));
  add_live_options(*command, arguments->live);
  command->footer(
      "The audit reads the EDS files and what the boot plan writes: heartbeat consumer (1016),\n"
      "life guarding (100C, 100D), error behaviour (1029), abort connection of drives (6007,\n"
      "605A, 605E), error values of outputs (6206, 6443 ...), deadlines of RPDOs and SYNC. With\n"
      "--bus or --live takt asks the devices by SDO and writes nothing. Exit code 1: a device\n"
      "keeps its last set-points.\n\n"
      "Example:\n"
      "  takt audit share/demo/two_axes.yaml");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace takt
