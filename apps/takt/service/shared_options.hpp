#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/service/scanned_devices.hpp"
#include "apps/takt/service/sdo_route.hpp"

namespace takt {

/// Adds `--timeout` and `--listen` of a command that scans a bus.
inline void add_scan_times(CLI::App& verb, BusScanOptions& options) {
  add_number(verb, "--timeout", options.timeout_ms, "longest silence of a node, ms")
      ->check(CLI::Range(1, 60000))
      ->type_name("MS");
  add_number(verb, "--listen", options.listen_ms, "shortest time to listen to heartbeats, ms")
      ->check(CLI::Range(0, 600000))
      ->type_name("MS");
}

/// Adds the options of SdoRouteOptions other than the node. `bus_text` is the help of `--bus`.
inline void add_sdo_route(CLI::App& verb, SdoRouteOptions& options, const std::string& bus_text) {
  add_bus(verb, options.bus, bus_text)->type_name("IFACE");
  add_number(verb, "--timeout", options.timeout_ms,
             "longest silence of the device, ms (`sdo_timeout_ms` of the node; 1000 with --bus)")
      ->check(CLI::Range(1, 60000))
      ->type_name("MS");
  auto* network = verb.add_option("--network", options.device_files.network,
                                  "network file with the names of nodes and objects");
  network->type_name("FILE");
  verb.add_option("--eds", options.device_files.eds,
                  "EDS or DCF of the device, with the names of its objects")
      ->type_name("FILE")
      ->excludes(network);
  add_live_options(verb, options.live);
}

}  // namespace takt
