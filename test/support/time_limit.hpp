#pragma once
#include <chrono>

namespace takt::test {

/// Longest time that a test waits for an expected event. The limit ends a test that would hang. On
/// a very busy machine the event comes late, but long before this limit.
inline constexpr std::chrono::seconds time_limit{180};

}  // namespace takt::test
