#pragma once
#include <CLI/CLI.hpp>

#include "apps/takt/objects/known_device.hpp"

namespace takt {

/// Adds `--network` and `--eds`, the files in which names of objects are looked up.
inline void add_device_files(CLI::App& verb, DeviceFileOptions& options) {
  auto* network = verb.add_option("--network", options.network,
                                  "network file with the names of nodes and objects");
  network->type_name("FILE");
  verb.add_option("--eds", options.eds, "EDS or DCF of the device, with the names of its objects")
      ->type_name("FILE")
      ->excludes(network);
}

}  // namespace takt
