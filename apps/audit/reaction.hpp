#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/audit/device_values.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// What a device does when it hears nothing of the master any more, the worst last.
enum class Failsafe : std::uint8_t {
  harmless,  ///< it has no outputs
  stops,     ///< a drive stops, outputs take their error values
  untold,    ///< it notices, but what its outputs do stands only in its manual
  goes_on,   ///< the last set-points stay in force
};

/// What a device does when it has noticed that communication failed.
struct Reaction {
  Failsafe verdict = Failsafe::untold;
  std::string text{};
  std::vector<std::string> remedy{};  ///< entries of `sdo:` in the network file
};

/// Abort connection (0x6007) of every axis, quick stop (0x605A) and fault reaction (0x605E).
/// CiA 402-2.
Reaction drive_reaction(const DeviceValues& values);

/// Error modes and values (0x6206 and 0x6207, 0x6443 and 0x6444 ...) of what the master commands.
/// CiA 401.
Reaction output_reaction(const BusPlan& plan, std::size_t node_index, const DeviceValues& values);

}  // namespace takt
