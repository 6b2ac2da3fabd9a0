#pragma once
#include <chrono>

namespace takt {

/// A point in time on the monotonic clock, or a duration. Milliseconds exist only on the wire and
/// in files.
using Time = std::chrono::nanoseconds;

/// The deadline of a state machine that waits for nothing.
inline constexpr Time never = Time::max();

}  // namespace takt
