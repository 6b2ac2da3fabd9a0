#pragma once
#include <cstddef>
#include <expected>
#include <functional>
#include <string>
#include <vector>

#include "apps/audit/device_values.hpp"
#include "eds_parser/table/ids.hpp"

namespace takt {

/// Why an object could not be read.
struct UnreadObject {
  std::uint32_t abort_code = 0;  ///< 0: no answer
  std::string sentence{};
};

/// Reads one object of a device by SDO. Nothing is written.
using ReadObject =
    std::function<std::expected<std::vector<std::byte>, UnreadObject>(NodeId, ObjectKey)>;

/// Asks a device for all that an audit is about. False: it did not answer, and what EDS and network
/// file say is left as it was.
bool ask_device(NodeId node, DeviceValues& values, const ReadObject& read);

}  // namespace takt
