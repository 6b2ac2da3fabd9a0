#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "eds_parser/cob_ids.hpp"
#include "eds_parser/table/sdo_access.hpp"

namespace takt {

/// An SDO server of a device besides the first: 0x1201..0x127F. CiA 301, 7.5.2.33.
struct SdoServer {
  std::uint16_t index = 0;
  SdoChannel channel;
  SourcePos pos;      ///< in the network file
  std::string doubt;  ///< not empty: only the device data have it on; what they say
};

/// Those that the network file, else the device file, else the device data have on.
std::vector<SdoServer> active_sdo_servers(const NodeSource& node);

/// A COB-ID entry of the device file for this node; 0: none, or the plain number of an EDS, which
/// is that of the node it was taken from.
std::int64_t cob_id_of_file(const ObjectDictionary& dictionary, ObjectKey key);

/// Warns where no SDO server of the device file or the device data has the COB-IDs of
/// `sdo_channel`.
void check_sdo_channel(const NodeSource& node, NetworkReport& report);

}  // namespace takt
