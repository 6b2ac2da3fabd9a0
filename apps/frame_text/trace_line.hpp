#pragma once
#include <optional>
#include <string_view>

#include "apps/frame_text/candump_line.hpp"

namespace takt {

/// One line of a recording: of candump, else of a PCAN trace (.trc, versions 1.0 to 2.1), of a
/// Vector log (.asc, its numbers to `vector_base`) or of what python-can prints. The stamp of a
/// PCAN trace becomes seconds; an error frame of a trace or a log has no class. None: another line,
/// or a frame of CAN FD.
std::optional<CandumpLine> parse_recorded(std::string_view text, int vector_base = 16);

/// What holds for the lines of a Vector log.
struct VectorHead {
  int base = 16;          ///< of its numbers
  bool relative = false;  ///< a time is the difference to that of the line before
};

/// `base dec  timestamps relative`. None: another line.
std::optional<VectorHead> vector_head(std::string_view text);

/// Blank, or a line that such files hold beside frames: comments, heads, triggers, states of the
/// controller.
bool is_remark(std::string_view text);

}  // namespace takt
