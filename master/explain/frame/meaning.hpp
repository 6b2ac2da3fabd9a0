#pragma once
#include <string>
#include <string_view>

namespace takt {

/// Meaning of a frame in CANopen.
struct FrameMeaning {
  std::string_view service = "?";  ///< "NMT", "SYNC", "EMCY", "TIME", "TPDO", "RPDO", "SDO", ...
  unsigned node = 0;               ///< node-ID; 0 means no node or all nodes
  std::string text{};              ///< text after the service, "shoulder operational"
};

}  // namespace takt
