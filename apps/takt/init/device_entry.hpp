#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/takt/service/scanned_devices.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt::init {

/// A device on the bus, with the data for its entry in the network file.
struct DeviceToWrite {
  ScannedDevice found;
  std::string file{};  ///< path of its device file in the network file
  /// Device data of the family of the device; nullptr if there are none.
  const DeviceData* data = nullptr;
  /// Counts per turn of the shaft behind the gear, read from the device (0x608F, 0x6091).
  std::optional<double> counts_a_turn{};
  /// Another node-ID under which the device answers, through its second SDO channel; 0 if there is
  /// none.
  std::uint8_t second_id = 0;
};

/// The extent of a proposal for an entry. If taktd does not accept the whole proposal, the entry
/// contains less.
enum class Detail { whole, own_pdos, file_only };

/// A limit that the plan proposes, with its reason.
struct ProposedLimit {
  std::string entry;      ///< `velocity: 12.5`, or `objects: [{...}]`; "..." stands for a number
  std::string because{};  ///< source of the limit, or what to enter

  bool has_numbers() const { return entry.find("...") == entry.npos; }
};

/// Returns true if `other` is not a separate device: `device` answers under the node-ID of `other`
/// through another SDO channel, which the device data describe. An example is channel 2 of the
/// Lenze 8400 at 0x640 + node-ID.
bool is_second_channel(const DeviceToWrite& device, const DeviceToWrite& other);
/// Returns the name of a node by its profile: `axis_5`, `io_10`, `inverter_3`.
std::string node_name(const DeviceToWrite& device);
/// Returns the entry of a device in `nodes:`, with comments.
std::string device_entry(const DeviceToWrite& device, Detail detail,
                         const std::vector<ProposedLimit>& limits);
/// Returns the comment for a device that can't have an entry, with the reason.
std::string missing_entry(const DeviceToWrite& device, const std::string& reason);

}  // namespace takt::init
