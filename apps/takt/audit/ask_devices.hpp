#pragma once
#include <cstddef>
#include <expected>
#include <functional>
#include <string>
#include <vector>

#include "apps/takt/audit/device_values.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// Reason why an object could not be read.
struct UnreadObject {
  std::uint32_t abort_code = 0;  ///< SDO abort code; 0 means that the device did not answer
  std::string sentence{};
};

/// Reads one object of a device by SDO. The function writes nothing to the device.
using ReadObject =
    std::function<std::expected<std::vector<std::byte>, UnreadObject>(NodeId, ObjectKey)>;

/// Reads all objects that an audit needs from a device. Returns false if the device did not answer;
/// `values` then keeps the values of the EDS and the network file.
bool ask_device(NodeId node, DeviceValues& values, const ReadObject& read);

}  // namespace takt
