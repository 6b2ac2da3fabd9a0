#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "apps/audit/device_values.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// How a device notices that the master is gone.
struct Supervision {
  std::optional<Time> after{};  ///< longest time; none: never
  bool by_sync = false;         ///< it acts when SYNC stays away, after a time that 0x1006 hints at
  std::string how{};            ///< "the master's heartbeat stays away (1016:01)"
  std::vector<std::string> besides{};  ///< deadlines that tell of errors and ensure nothing
};

/// Heartbeat consumer (0x1016), life guarding (0x100C, 0x100D), SYNC (0x1006), deadlines of RPDOs.
Supervision supervision_of(const BusPlan& plan, std::size_t node_index, const DeviceValues& values);

/// Lines for the network file that make it notice, none that are the default already. `master`: the
/// one for the master is needed. Both empty: nothing in the network file can make it notice.
struct SupervisionRemedy {
  std::vector<std::string> node{};
  std::string master{};
  std::string why{};  ///< why it can't watch heartbeats although it has 0x1016
};
SupervisionRemedy supervision_remedy(const BusPlan& plan, std::size_t node_index,
                                     const DeviceValues& values);

}  // namespace takt
