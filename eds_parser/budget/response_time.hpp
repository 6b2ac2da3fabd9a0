#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Frames of one identifier: their largest rate, and the time of each on the wire.
struct FrameStream {
  std::uint64_t priority =
      0;  ///< a smaller value goes first, equal values in any order; on CAN this is the identifier
  Time frame{};   ///< longest time of the frame, with the worst stuffing and the interframe space
  Time period{};  ///< shortest distance between two frames; > 0
  Time jitter{};  ///< time by which a frame may be queued later than its period
  unsigned burst = 1;  ///< number of frames at once in each period
  bool counts = true;  ///< false: this stream delays no other stream
};

/// Errors on the wire: `burst` errors at once, then at most one in each `interval`. 0 means no
/// errors.
struct WireErrors {
  unsigned burst = 0;
  Time interval{};
};

/// Returns the bus time that errors cost within `time`, if the longest repeated frame takes
/// `frame`.
Time error_time(Time time, const WireErrors& errors, Time bit, Time frame) noexcept;

/// Returns for each stream the worst-case time from queueing to the end of the frame. It is empty
/// if there is no bound, because this priority and those above it need the whole bus. The method is
/// that of Davis, Burns, Bril, Lukkien 2007, with all instances of the busy period. `bit` is one
/// bit time.
std::vector<std::optional<Time>> worst_responses(std::span<const FrameStream> streams, Time bit,
                                                 const WireErrors& errors = {});

}  // namespace takt
