#pragma once
#include <set>
#include <string>

#include "apps/takt/learn/device_files.hpp"
#include "apps/takt/learn/learned_bus.hpp"

namespace takt::learn {

/// A node with the known properties of its device and of the master.
struct NodeToWrite {
  const LearnedNode& node;
  const ObjectDictionary* dictionary = nullptr;
  std::string dcf;    ///< path of the device file in the network file
  bool made = false;  ///< true if the device file was made from the recording
  std::uint8_t master_id = 127;
  std::int64_t master_heartbeat_ms = 0;
  std::int64_t sync_us = 0;
  std::uint32_t inhibit_unit_us = 100;  ///< unit of the inhibit time (sub-index 3) of the PDOs
};

/// Writes one entry of `nodes:`. An observation that a network file can't express becomes a
/// comment, and also a finding if it is important.
std::string node_text(const NodeToWrite& node, const LearnedBus& bus, Findings& findings);

/// Returns the name of a node, `node_5`.
std::string node_name(std::uint8_t id);

/// Returns true for objects 0x1000..0x1FFF that have a key in the network file.
bool has_key_of_its_own(ObjectKey key) noexcept;

}  // namespace takt::learn
