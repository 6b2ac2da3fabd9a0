#pragma once
#include <chrono>

namespace takt {

/// A point on the monotonic clock, or a span of it. Milliseconds exist only on the wire and in
/// files.
using Time = std::chrono::nanoseconds;

/// The deadline of a machine that waits for nothing.
inline constexpr Time never = Time::max();

}  // namespace takt
