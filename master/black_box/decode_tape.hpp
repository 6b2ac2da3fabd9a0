#pragma once
#include <cstdint>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/core/event.hpp"
#include "master/rt/journal/journal.hpp"

namespace takt {

/// A frame of the tape and its time, which determines its place in the log.
struct LoggedFrame {
  Time when{};  ///< monotonic
  Frame frame{};
};

/// Contents of a tape, separated into journal, frames and events.
struct DecodedTape {
  std::vector<std::uint64_t> words;  ///< words of the journal, see Recording::words
  std::vector<LoggedFrame> frames;   ///< frames in the order of their times
  std::vector<Event> events;
  /// Newest offset from the monotonic clock to the time since 1970. 0 means unknown.
  Time since_1970{};
};

/// Separates the records that Tape::read() returns.
DecodedTape decode_tape(const std::vector<std::uint64_t>& records);

}  // namespace takt
