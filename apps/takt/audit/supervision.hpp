#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "apps/takt/audit/device_values.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// Ways in which a device notices that the master is gone.
struct Supervision {
  /// Longest time until the device notices. Empty if neither heartbeat nor life guarding notices
  /// it.
  std::optional<Time> after{};
  /// True if the device reacts to missing SYNC, after a time that depends on 0x1006.
  bool by_sync = false;
  std::string how{};  ///< "no heartbeat of the master arrives (1016:01)"
  /// Further remarks, for example on deadlines that report errors but ensure no reaction.
  std::vector<std::string> besides{};
};

/// Evaluates heartbeat consumer (0x1016), life guarding (0x100C, 0x100D), SYNC (0x1006) and the
/// deadlines of RPDOs.
Supervision supervision_of(const BusPlan& plan, std::size_t node_index, const DeviceValues& values);

/// Line without which takt writes nothing to the device.
inline constexpr const char* boot_line = "boot: true   # takt configures the device";

/// Lines for the network file that make a device notice the loss of the master. Lines that only
/// repeat a default are left out. If `node`, `master` and `removal` are empty, no entry of the
/// network file can make the device notice.
struct SupervisionRemedy {
  std::vector<std::string> node{};  ///< lines below the node's name
  std::string master{};             ///< line for the master; empty if none is needed
  std::string removal{};  ///< entry of the network file that has to be removed; empty if none
  std::string why{};      ///< why the device can't watch heartbeats although it has 0x1016
};

/// Finds the lines for a device that does not notice the loss of the master.
SupervisionRemedy supervision_remedy(const BusPlan& plan, std::size_t node_index,
                                     const DeviceValues& values);

}  // namespace takt
