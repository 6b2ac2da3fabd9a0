#pragma once
#include <optional>
#include <string_view>

#include "apps/frame_text/candump_line.hpp"

namespace takt {

/// One line of a recording: of candump, else of a PCAN trace (.trc, versions 1.0 to 2.1), of a
/// Vector log (.asc, its numbers to `vector_base`) or of what python-can prints. The stamp of a
/// PCAN trace becomes seconds. None: another line, or a frame of CAN FD.
std::optional<CandumpLine> parse_recorded(std::string_view text, int vector_base = 16);

/// Of the head of a Vector log, `base dec`: 10 or 16, for the lines that follow. None: another
/// line.
std::optional<int> vector_base(std::string_view text);

/// Blank, or a line that such files hold beside frames: comments, heads, triggers, states of the
/// controller.
bool is_remark(std::string_view text);

}  // namespace takt
