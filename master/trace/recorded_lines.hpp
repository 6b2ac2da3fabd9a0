#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "master/trace/candump_line.hpp"

namespace takt {

/// Reads a recording line by line, in any of the formats of parse_recorded(). The head of a Vector
/// log determines how the numbers and times of the following lines are read.
class RecordedLines {
 public:
  /// Reads the next line. Time stamps that are differences become times since the head. Returns
  /// std::nullopt if the line holds no frame.
  std::optional<CandumpLine> parse(std::string_view text);

 private:
  void advance(std::string_view text);

  int base_ = 16;
  bool relative_ = false;
  std::uint64_t us_ = 0;  // microseconds since the head; only if times are relative
};

}  // namespace takt
