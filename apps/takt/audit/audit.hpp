#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/takt/audit/device_values.hpp"
#include "apps/takt/audit/reaction.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// NMT state into which a device changes after a communication error. 0x1029:01, CiA 301, 7.5.2.32.
/// `unspecified` stands for a value that the manufacturer defines.
enum class ErrorState : std::uint8_t { preoperational, operational, stopped, unspecified };

/// Result of the audit of one node.
struct NodeAudit {
  std::string name{};
  std::uint8_t id = 0;
  bool drive = false;
  Failsafe verdict = Failsafe::goes_on;
  /// Longest time until the device notices the death of the master or a cut cable. Empty if no
  /// timer of the device notices that.
  std::optional<Time> notices{};
  std::string how{};  ///< how the device notices, "no heartbeat of the master arrives (1016:01)"
  ErrorState state = ErrorState::preoperational;
  std::string then{};                  ///< change of the NMT state by 0x1029; empty if none
  std::string outputs{};               ///< reaction of the drive or of the outputs
  std::string bus_off{};               ///< reaction if the device's own controller goes bus-off
  std::vector<std::string> besides{};  ///< further remarks
  std::vector<std::string> remedy{};   ///< lines for the network file, below the node's name
  std::string master_remedy{};         ///< line for the network file as a whole
};

/// Result of the audit of a bus.
struct Audit {
  std::string bus{};
  std::uint8_t master_id = 0;
  Time heartbeat{};    ///< heartbeat period of the master; 0 means no heartbeat
  bool asked = false;  ///< true: values of the devices, read by SDO; false: EDS and network file
  std::vector<NodeAudit> nodes{};
  /// Returns true if at least one device keeps its last set-points.
  bool goes_on() const;
};

/// Finds out what each device does when the master dies. `values` are in the order of plan.nodes.
Audit audit(const BusPlan& plan, const std::vector<DeviceValues>& values);

}  // namespace takt
