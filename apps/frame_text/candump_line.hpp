#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "master/wire/frame.hpp"

namespace takt {

/// One line of candump, of its log format (`-L`) or of its terminal format with or without a stamp.
struct CandumpLine {
  std::string stamp{};  ///< as written, without brackets; may be empty
  std::string interface{};
  Frame frame{};
  bool error_frame = false;  ///< of the controller: `frame.id` is its class, `frame` its bytes
};

/// None: not a line of candump, or a frame of CAN FD.
std::optional<CandumpLine> parse_candump(std::string_view text);

/// `(1436509052.249713)  vcan0  185   [2]  37 06`, the stamp only where there is one.
std::string to_string(const CandumpLine& line);

}  // namespace takt
