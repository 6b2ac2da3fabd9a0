#include "master/linux/clock.hpp"

#include <cerrno>

namespace takt {
namespace {

void relax() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

}  // namespace

Time realtime_offset() noexcept {
  constexpr Time good_enough = std::chrono::microseconds{2};
  Time best{};
  Time best_width = Time::max();
  for (int tries = 0; tries < 3 && best_width > good_enough; ++tries) {
    const Time before = monotonic_now();
    const Time real = realtime_now();
    const Time width = monotonic_now() - before;
    if (width >= best_width) continue;
    best_width = width;
    best = real - (before + width / 2);
  }
  return best;
}

void sleep_until(Time until) noexcept {
  const timespec t = to_timespec(until);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

void sleep_precisely_until(Time until, Time spin) noexcept {
  if (monotonic_now() < until - spin) sleep_until(until - spin);
  while (monotonic_now() < until) relax();
}

}  // namespace takt
