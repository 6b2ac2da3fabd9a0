#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "master/wire/frame.hpp"

namespace takt {

/// One line of candump, in its log format (`-L`) or in its terminal format, with or without a time
/// stamp.
struct CandumpLine {
  std::string stamp{};  ///< text of the time stamp as written, without brackets; may be empty
  std::string interface{};
  Frame frame{};
  bool error_frame = false;  ///< true: error frame; `frame.id` is its class, `frame` its bytes
};

/// Reads a line of candump. Returns std::nullopt if the text is another line or a frame of CAN FD.
std::optional<CandumpLine> parse_candump(std::string_view text);

/// Returns a line like `(1436509052.249713)  vcan0  185   [2]  37 06`, without brackets if the line
/// has no time stamp.
std::string to_string(const CandumpLine& line);

}  // namespace takt
