#pragma once
#include <cstdint>
#include <vector>

#include "eds_parser/table/time.hpp"
#include "master/core/event.hpp"
#include "master/rt/journal.hpp"

namespace takt {

/// A frame of the tape and its place in the log.
struct LoggedFrame {
  Time when{};  ///< monotonic
  Frame frame{};
};

/// A tape, taken apart.
struct UnravelledTape {
  std::vector<std::uint64_t> words;  ///< as Recording::words
  std::vector<LoggedFrame> frames;   ///< in the order of their times
  std::vector<Event> events;
  Time since_1970{};  ///< the newest; 0 = not known
};

/// `records` as Tape::read() gives them.
UnravelledTape unravel(const std::vector<std::uint64_t>& records);

}  // namespace takt
