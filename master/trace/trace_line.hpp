#pragma once
#include <optional>
#include <string_view>

#include "master/trace/candump_line.hpp"

namespace takt {

/// Reads one line of a recording. The formats are candump, PCAN trace (.trc, versions 1.0 to 2.1),
/// Vector log (.asc, numbers to the base `vector_base`) and the text that python-can prints. The
/// time stamp of a PCAN trace becomes seconds. An error frame of a trace or a log has no class.
/// Returns std::nullopt if the text is another line or a frame of CAN FD.
std::optional<CandumpLine> parse_recorded(std::string_view text, int vector_base = 16);

/// Settings in the head of a Vector log that apply to its lines.
struct VectorHead {
  int base = 16;          ///< base of the numbers, 10 or 16
  bool relative = false;  ///< true: each time is the difference to the line before
};

/// Reads a head like `base dec  timestamps relative`. Returns std::nullopt if the text is another
/// line.
std::optional<VectorHead> vector_head(std::string_view text);

/// Returns true if the line is blank or holds something else than a frame: a comment, a head, a
/// trigger, or a state of the controller.
bool is_remark(std::string_view text);

}  // namespace takt
