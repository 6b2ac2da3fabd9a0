#pragma once
#include <string>

#include "apps/takt/simulate/simulation.hpp"
#include "test/support/folder.hpp"

namespace takt::test {

struct Machine {
  std::string master{};
  std::string sdo{};
  std::string second_tpdo = "{transmission: 1, cob_id: auto, mapping: [{index: 0x606C}]}";
};

/// A network with two drives that count in um. `master` adds keys to the master, and `sdo` adds
/// objects to drive z.
inline LoadedNetwork machine(const test::Folder& folder, const Machine& machine = {}) {
  const std::string axis =
      "dcf: " TAKT_SOURCE_DIR
      "/share/eds/takt_drive402.eds\n"
      "    profile: cia402\n"
      "    units: {position: {scale: 1.0e-6, unit: m}, velocity: {scale: 1.0e-6, unit: m/s}}\n"
      "    tpdo:\n"
      "      1: {transmission: 1, cob_id: auto, mapping: [{index: 0x6041}, {index: 0x6064}]}\n"
      "      2: " +
      machine.second_tpdo +
      "\n"
      "      3: {enabled: false}\n"
      "      4: {enabled: false}\n"
      "    rpdo:\n"
      "      1: {transmission: 1, cob_id: auto, mapping: [{index: 0x6040}, {index: 0x607A}]}\n"
      "      2: {transmission: 1, cob_id: auto, mapping: [{index: 0x6060}]}\n"
      "      3: {enabled: false}\n"
      "      4: {enabled: false}\n";
  return load_network(folder.write("net.yaml",
                                   "bus: {name: lift, bitrate_kbit: 1000}\n"
                                   "master: {sync_period: 4000, heartbeat_producer: 100" +
                                       machine.master +
                                       "}\n"
                                       "nodes:\n"
                                       "  y:\n    node_id: 1\n    " +
                                       axis + "  z:\n    node_id: 2\n    " + axis + "    sdo: [" +
                                       machine.sdo + "]\n"));
}

}  // namespace takt::test
