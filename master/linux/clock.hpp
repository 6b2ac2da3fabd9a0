#pragma once
#include <time.h>

#include "eds_parser/table/time.hpp"

namespace takt {

/// CLOCK_MONOTONIC, the time of everything inside takt. A vDSO read, no system call.
inline Time monotonic_now() noexcept {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::chrono::seconds{t.tv_sec} + Time{t.tv_nsec};
}

inline Time realtime_now() noexcept {
  timespec t{};
  clock_gettime(CLOCK_REALTIME, &t);
  return std::chrono::seconds{t.tv_sec} + Time{t.tv_nsec};
}

/// CLOCK_REALTIME minus CLOCK_MONOTONIC now. Being preempted between the two reads is noticed and
/// the reading repeated, so the error stays in the order of a microsecond.
Time realtime_offset() noexcept;

/// One clock_nanosleep to an absolute monotonic time; never early.
void sleep_until(Time until) noexcept;

/// Sleeps to `until - spin` and burns the rest. Late only by what the scheduler takes beyond
/// `spin`.
void sleep_precisely_until(Time until, Time spin) noexcept;

constexpr timespec to_timespec(Time time) noexcept {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time);
  return {.tv_sec = seconds.count(), .tv_nsec = (time - seconds).count()};
}

}  // namespace takt
