#pragma once
#include <string>
#include <string_view>

namespace takt {

/// What a frame means to CANopen.
struct FrameMeaning {
  std::string_view service = "?";  ///< "NMT", "SYNC", "EMCY", "TIME", "TPDO", "RPDO", "SDO", ...
  unsigned node = 0;               ///< 0: none, or all
  std::string text{};              ///< after the service: "shoulder operational"
};

}  // namespace takt
