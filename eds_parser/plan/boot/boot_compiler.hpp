#pragma once
#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/network_spec.hpp"
#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/output_limits.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// The settings of the whole network that the boot of one node needs.
struct BootContext {
  NodeId master_id;
  /// Heartbeat period of the master in milliseconds. 0 means that the master produces none.
  std::uint16_t master_heartbeat_ms = 0;
  /// Longest silence of the master that a device accepts, in milliseconds.
  std::uint16_t master_consumer_ms = 0;
  std::uint16_t producer_ms = 0;  ///< 0x1017 of this node in milliseconds; 0 means no heartbeat
  Time heartbeat_timeout{};       ///< 0 means that the master does not watch the heartbeat
  GuardPlan guard{};              ///< node guarding, used if there is no heartbeat
  bool sync = false;
  std::uint32_t sync_cob_id = 0x80;
  std::string sync_source{};  ///< name of the SYNC producer for messages
  bool makes_sync = false;    ///< This node is the SYNC producer.
  std::uint32_t sync_period_us = 0;
  std::uint8_t sync_overflow = 0;
  Sourced<std::uint32_t> sync_window_us;
  bool start_nodes = true;
  /// The master starts all nodes at once instead of each node by its boot plan.
  bool start_all = false;
  bool cia402 = false;
  std::span<const DeviceLimit> limits{};  ///< the limits of all nodes
  std::uint8_t node_index = 0;
  Time sdo_timeout{};
  Time boot_timeout{};
};

/// Compiles the boot of one node into a linear program: reset, probe, identity, restore, heartbeat,
/// SYNC, configuration values, PDOs, start. CiA 302-2, part E of the reference.
BootPlan compile_boot(const NodePdos& node, const BootContext& context, NetworkReport& report);

/// Returns true if the device has object 0x1017 and the master can write it.
bool has_heartbeat_producer(const ObjectDictionary& dictionary) noexcept;

}  // namespace takt
