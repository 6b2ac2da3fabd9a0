#pragma once
#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/network_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// The data of the network that the compilation of one boot needs.
struct BootContext {
  const MasterSpec& master;
  const BusPlan& plan;   ///< complete except for the boots
  const NodePlan& node;  ///< the node that is booted, complete except for its boot
  /// Longest silence of the master that a device accepts, in milliseconds. 0 means that the master
  /// produces no heartbeat.
  std::uint16_t master_consumer_ms = 0;
  std::uint16_t producer_ms = 0;  ///< 0x1017 of this node in milliseconds; 0 means no heartbeat
  std::uint8_t node_index = 0;

  bool makes_sync() const noexcept { return plan.cycle.sync_producer == node.id; }
};

/// Compiles the boot of one node into a linear program: reset, probe, identity, restore, heartbeat,
/// SYNC, configuration values, PDOs, start. CiA 302-2.
BootPlan compile_boot(const NodePdos& node, const BootContext& context, NetworkReport& report);

/// Returns true if the device has object 0x1017 and the master can write it.
bool has_heartbeat_producer(const ObjectDictionary& dictionary) noexcept;

}  // namespace takt
