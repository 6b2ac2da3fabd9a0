#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/table/sdo_access.hpp"

namespace takt {

/// A further SDO server of a device, in addition to the default server: 0x1201..0x127F. CiA 301,
/// 7.5.2.33.
struct DeviceSdoServer {
  std::uint16_t index = 0;
  SdoChannel channel;
  SourcePos pos;  ///< place in the network file
  /// If only the device data say that this server is on, this text quotes them. Otherwise it is
  /// empty.
  std::string doubt{};
};

/// Returns the further SDO servers that are on according to the network file, else the device file,
/// else the device data.
std::vector<DeviceSdoServer> active_sdo_servers(const NodeSource& node);

/// Returns the COB-ID that the device file states for this node, or 0 if there is none. A plain
/// number in an EDS also gives 0, because it is the COB-ID of the node from which the EDS was
/// taken.
std::int64_t cob_id_of_file(const ObjectDictionary& dictionary, ObjectKey key);

/// Warns if no SDO server of the device file or the device data has the COB-IDs of `sdo_channel`.
void check_sdo_channel(const NodeSource& node, NetworkReport& report);

}  // namespace takt
