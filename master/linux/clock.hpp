#pragma once
#include <time.h>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Reads a clock of the system in the vDSO, without a system call.
inline Time time_on(clockid_t clock) noexcept {
  timespec t{};
  clock_gettime(clock, &t);
  return std::chrono::seconds{t.tv_sec} + Time{t.tv_nsec};
}
/// Returns CLOCK_MONOTONIC, the time base of takt.
inline Time monotonic_now() noexcept { return time_on(CLOCK_MONOTONIC); }
inline Time realtime_now() noexcept { return time_on(CLOCK_REALTIME); }

/// Returns CLOCK_REALTIME minus CLOCK_MONOTONIC. The function detects preemption between the two
/// reads and repeats the reading, so the error stays in the order of a microsecond.
Time realtime_offset() noexcept;

/// Sleeps with clock_nanosleep until an absolute monotonic time; never returns early.
void sleep_until(Time until) noexcept;

/// Sleeps until `until - spin` and spins for the rest. The return is late only by the time that the
/// scheduler takes beyond `spin`.
void sleep_precisely_until(Time until, Time spin) noexcept;

constexpr timespec to_timespec(Time time) noexcept {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time);
  return {.tv_sec = seconds.count(), .tv_nsec = (time - seconds).count()};
}

}  // namespace takt
