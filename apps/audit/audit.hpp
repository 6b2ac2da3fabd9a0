#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/audit/device_values.hpp"
#include "apps/audit/reaction.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// NMT state that a communication error brings a device into. 0x1029:01, CiA 301, 7.5.2.32.
enum class ErrorState : std::uint8_t { preoperational, operational, stopped, untold };

struct NodeAudit {
  std::string name{};
  std::uint8_t id = 0;
  bool drive = false;
  Failsafe verdict = Failsafe::goes_on;
  std::optional<Time> notices{};  ///< the master's death, or a cut cable; none: never
  std::string how{};              ///< "the master's heartbeat stays away (1016:01)"
  ErrorState state = ErrorState::preoperational;
  std::string then{};                  ///< NMT, by 0x1029; empty: nothing
  std::string outputs{};               ///< what the drive or the outputs do
  std::string bus_off{};               ///< its own controller goes bus-off
  std::vector<std::string> besides{};  ///< what else there is to know
  std::vector<std::string> remedy{};   ///< lines for the network file, below the node's name
  std::string master_remedy{};         ///< line for the network file as a whole
};

struct Audit {
  std::string bus{};
  std::uint8_t master_id = 0;
  Time heartbeat{};    ///< of the master; 0: none
  bool asked = false;  ///< the devices themselves, by SDO
  std::vector<NodeAudit> nodes{};
  bool goes_on() const;  ///< some device does
};

/// What each device does when the master dies. `values` in the order of plan.nodes.
Audit audit(const BusPlan& plan, const std::vector<DeviceValues>& values);

}  // namespace takt
