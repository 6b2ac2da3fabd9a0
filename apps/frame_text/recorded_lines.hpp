#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "apps/frame_text/candump_line.hpp"

namespace takt {

/// A recording line by line, in any of the forms of parse_recorded(). What the head of a Vector log
/// says of its numbers and times holds for the lines that follow.
class RecordedLines {
 public:
  /// Stamps that are differences become times since the head. None: no frame.
  std::optional<CandumpLine> parse(std::string_view text);

 private:
  void advance(std::string_view text);

  int base_ = 16;
  bool relative_ = false;
  std::uint64_t us_ = 0;  ///< since the head, where times are relative
};

}  // namespace takt
