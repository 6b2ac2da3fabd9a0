#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/table/time.hpp"

namespace takt {

/// Frames of one identifier: when they come at most, and how long each is on the wire.
struct FrameStream {
  std::uint64_t priority = 0;  ///< the smaller goes first, of equals either; CAN: the identifier
  Time frame{};                ///< with worst stuffing and interframe space
  Time period{};               ///< least distance of two; > 0
  Time jitter{};               ///< how much later than its period one may be queued
  unsigned burst = 1;          ///< so many at once, each period
  bool counts = true;          ///< false: it delays no other
};

/// Errors on the wire: `burst` at once, then no two within `interval`. 0: none.
struct WireErrors {
  unsigned burst = 0;
  Time interval{};
};

/// What errors take within `time`, if the longest frame that is repeated takes `frame`.
Time error_time(Time time, const WireErrors& errors, Time bit, Time frame) noexcept;

/// Worst-case time from queueing to the end of the frame, of each stream; none where there is no
/// bound (its priority and those above it need the whole bus). Davis, Burns, Bril, Lukkien 2007,
/// with all instances of the busy period. `bit` is one bit time.
std::vector<std::optional<Time>> worst_responses(std::span<const FrameStream> streams, Time bit,
                                                 const WireErrors& errors = {});

}  // namespace takt
