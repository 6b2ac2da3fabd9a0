#pragma once
#include "eds_parser/cob_ids.hpp"
#include "eds_parser/network_report.hpp"
#include "eds_parser/network_spec.hpp"
#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/output_limits.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// What the whole network says to the boot of one node.
struct BootContext {
  NodeId master_id;
  std::uint16_t master_heartbeat_ms = 0;  ///< 0: the master produces none
  std::uint16_t master_consumer_ms = 0;   ///< silence of the master that a device accepts
  std::uint16_t producer_ms = 0;          ///< 0x1017 of this node, 0 = none
  Time heartbeat_timeout{};               ///< 0 = not watched
  GuardPlan guard{};                      ///< where there is no heartbeat
  bool sync = false;
  std::uint32_t sync_cob_id = 0x80;
  std::string sync_source{};  ///< who makes it, for people
  bool makes_sync = false;    ///< this node does
  std::uint32_t sync_period_us = 0;
  std::uint8_t sync_overflow = 0;
  Sourced<std::uint32_t> sync_window_us;
  bool start_nodes = true;
  bool start_all = false;  ///< not by the plan of each node
  bool cia402 = false;
  std::span<const DeviceLimit> limits{};  ///< of all nodes
  std::uint8_t node_index = 0;
  Time sdo_timeout{};
  Time boot_timeout{};
};

/// The boot of one node as a linear program. CiA 302-2, part E of the reference: reset, probe,
/// identity, restore, heartbeat, SYNC, configuration values, PDOs, start.
BootPlan compile_boot(const NodePdos& node, const BootContext& context, NetworkReport& report);

/// 0x1017 of the device can be written or, where it is fixed, its value is known.
bool has_heartbeat_producer(const ObjectDictionary& dictionary) noexcept;

}  // namespace takt
