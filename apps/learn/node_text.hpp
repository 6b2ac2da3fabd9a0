#pragma once
#include <set>
#include <string>

#include "apps/learn/device_files.hpp"
#include "apps/learn/learned_bus.hpp"

namespace takt {

/// A node beside what is known of its device and of the master.
struct NodeToWrite {
  const LearnedNode& node;
  const ObjectDictionary* dictionary = nullptr;
  std::string dcf;    ///< as the network file names it
  bool made = false;  ///< it holds only what the recording shows
  std::uint8_t master_id = 127;
  std::int64_t master_heartbeat_ms = 0;
  std::int64_t sync_us = 0;
  std::uint32_t inhibit_unit_us = 100;  ///< of sub 3 of this device's PDOs
};

/// One entry of `nodes:`. What the recording shows and a network file can't say becomes a comment,
/// and a finding where it matters.
std::string node_text(const NodeToWrite& node, const LearnedBus& bus, Findings& findings);

/// `node_5`.
std::string node_name(std::uint8_t id);

/// Objects of 1xxx that keys of the network file stand for.
bool has_key_of_its_own(ObjectKey key) noexcept;

}  // namespace takt
