#pragma once
#include <string>
#include <vector>

#include "apps/takt/audit/audit.hpp"
#include "test/boot/plant.hpp"

namespace takt::test {

inline std::string eds(const std::string& name) {
  return std::string{TAKT_SOURCE_DIR} + "/share/eds/" + name + ".eds";
}

inline std::string block(const std::string& name, const std::vector<std::string>& keys) {
  std::string text = "  " + name + ":\n";
  for (const std::string& key : keys) text += "    " + key + "\n";
  return text;
}

/// A drive (node 5) and an I/O module (node 6), each with more keys.
inline LoadedNetwork two_nodes(std::vector<std::string> axis, std::vector<std::string> io,
                               const std::string& master = "heartbeat_producer: 100") {
  axis.insert(axis.begin(), {"node_id: 5", "dcf: " + eds("takt_drive402"), "profile: cia402",
                             "on_timeout: {fallback: hold, after_cycles: 60000}",
                             "tpdo: {1: {transmission: 1, cob_id: auto, mapping: [{index: 0x6041}, "
                             "{index: 0x606C}]}, 2: {enabled: false}, 3: {enabled: false}, "
                             "4: {enabled: false}}",
                             "rpdo: {1: {transmission: 1, cob_id: auto, mapping: [{index: 0x6040}, "
                             "{index: 0x60FF}]}, 2: {transmission: 1, cob_id: auto, "
                             "mapping: [{index: 0x6060}]}, 3: {enabled: false}, "
                             "4: {enabled: false}}"});
  io.insert(io.begin(), {"node_id: 6", "dcf: " + eds("takt_io401"),
                         "on_timeout: {fallback: hold, after_cycles: 60000}",
                         "rpdo: {1: {transmission: 1, cob_id: auto}, "
                         "2: {transmission: 1, cob_id: auto}}"});
  return network_of("bus: {name: lift, interface: can0}\nmaster: {sync_period: 10000, " + master +
                    "}\nnodes:\n" + block("axis", axis) + block("io", io));
}

inline Audit audit_of(const LoadedNetwork& network) {
  std::vector<DeviceValues> values;
  for (std::size_t i = 0; i < network.plan.nodes.size(); ++i) {
    values.emplace_back(network.plan.nodes[i], network.devices[i]);
  }
  return audit(network.plan, values);
}

}  // namespace takt::test
