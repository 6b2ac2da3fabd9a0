#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/takt/audit/device_values.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Behaviour of a device that no longer receives anything from the master, in the order of
/// severity.
enum class Failsafe : std::uint8_t {
  harmless,     ///< The device has no outputs.
  stops,        ///< The drive stops, or the outputs take their error values.
  unspecified,  ///< The device notices, but only its manual says what its outputs do.
  goes_on,      ///< The last set-points stay in force.
};

/// Reaction of a device that has noticed a failure of the communication.
struct Reaction {
  Failsafe verdict = Failsafe::unspecified;
  std::string text{};
  std::vector<std::string> remedy{};  ///< entries of `sdo:` in the network file
  /// Objects that would have to change, but for which the EDS permits no suitable value.
  std::vector<ObjectKey> fixed{};
};

/// Returns the reaction of a drive, by the option codes of every axis: abort connection (0x6007),
/// quick stop (0x605A) and fault reaction (0x605E). CiA 402-2.
Reaction drive_reaction(const DeviceValues& values);

/// Returns the reaction of the outputs that the master commands, by their error modes and error
/// values (0x6206 and 0x6207, 0x6443 and 0x6444 ...). CiA 401.
Reaction output_reaction(const BusPlan& plan, std::size_t node_index, const DeviceValues& values);

}  // namespace takt
