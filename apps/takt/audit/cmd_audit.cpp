#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>
#include <memory>
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

struct AuditArguments {
  std::string network;
  LiveOptions live;
  std::string bus;
  bool through_daemon = false;
  int timeout_ms = 500;
};

/// Calls `read` for an object of a device. A refusal by the device becomes an UnreadObject; all
/// other failures end the audit.
std::expected<std::vector<std::byte>, UnreadObject> try_to_read(
    const std::function<std::vector<std::byte>()>& read) {
  try {
    return read();
  } catch (const Failure& failure) {
    if (failure.code != 1) throw;
    return std::unexpected{UnreadObject{failure.abort_code, failure.what()}};
  }
}

std::vector<std::byte> read_by_daemon(DaemonClient& daemon, NodeId node, ObjectKey key,
                                      int timeout_ms) {
  request_t request = make_request("sdo_upload", node.value());
  request.index = key.index;
  request.sub = key.sub;
  request.timeout_ms = timeout_ms;
  const reply_t reply =
      daemon.demand(std::move(request), milliseconds{timeout_ms} * 10 + std::chrono::seconds{2});
  const auto bytes = std::as_bytes(std::span{reply.data});
  return {bytes.begin(), bytes.end()};
}

/// Returns how to read an object: directly on the bus, or through the daemon of the bus.
ReadObject reader(const AuditArguments& arguments, const std::string& bus_name) {
  const int timeout_ms = arguments.timeout_ms;
  if (!arguments.bus.empty()) {
    return [bus = arguments.bus, timeout_ms](NodeId node, ObjectKey key) {
      return try_to_read(
          [&] { return SdoDirect{bus, node, milliseconds{timeout_ms}}.upload(key); });
    };
  }
  LiveOptions live = arguments.live;
  if (live.bus_name.empty()) live.bus_name = bus_name;
  const auto daemon = std::make_shared<DaemonClient>(DaemonClient::find(live));
  return [daemon, timeout_ms](NodeId node, ObjectKey key) {
    return try_to_read([&] { return read_by_daemon(*daemon, node, key, timeout_ms); });
  };
}

/// Asks every device. Throws a Failure if no device answers.
void ask(const BusPlan& plan, std::vector<DeviceValues>& values, const ReadObject& read) {
  bool any = values.empty();
  for (std::size_t i = 0; i < values.size(); ++i) {
    any |= ask_device(plan.nodes[i].id, values[i], read);
  }
  if (!any) throw Failure{"no device of '" + plan.name + "' answers"};
}

int run(const AuditArguments& arguments) {
  const LoadedNetwork network = load_network(arguments.network);
  if (print_findings(network.findings, Severity::warning)) return 2;
  std::vector<DeviceValues> values;
  for (std::size_t i = 0; i < network.plan.nodes.size(); ++i) {
    values.emplace_back(network.plan.nodes[i], network.devices[i]);
  }
  const bool asks = !arguments.bus.empty() || arguments.through_daemon;
  if (asks) ask(network.plan, values, reader(arguments, network.plan.name));
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
  auto [command, arguments] = add_command<AuditArguments>(
      app, exit_code, "audit", "reports what devices do if the master, the cable or the bus fails",
      run);
  command.add_option("NET", arguments.network, "network file (YAML, also a bus.yml)")->required();
  add_bus(command, arguments.bus, "ask the devices on this bus directly; stop the daemon first")
      ->type_name("IFACE");
  command.add_flag("--live", arguments.through_daemon, "ask the devices through the daemon");
  add_number(command, "--timeout", arguments.timeout_ms, "longest wait for each answer, ms")
      ->check(CLI::Range(1, 60'000));
  add_live_options(command, arguments.live);
  command.footer(
      "The audit reads the EDS files and what the boot plan writes: heartbeat consumer (1016),\n"
      "life guarding (100C, 100D), error behaviour (1029), abort connection of drives (6007,\n"
      "605A, 605E), error values of outputs (6206, 6443 ...), deadlines of RPDOs and SYNC. With\n"
      "--bus or --live takt asks the devices by SDO and writes nothing. Exit code 1: a device\n"
      "keeps its last set-points.\n\n"
      "Example:\n"
      "  takt audit share/demo/two_axes.yaml");
}

}  // namespace takt
