#pragma once
#include "eds_parser/values/time.hpp"

namespace takt::sim {

/// The clock of a device, which may run slightly fast or slow. |ppm| must be below 100,000.
class LocalClock {
 public:
  Time local(Time world) const noexcept { return ppm_ == 0 ? world + offset_ : drifted(world); }
  /// Returns the earliest world time at which the local clock shows `local_time` or more.
  Time world(Time local_time) const noexcept {
    if (local_time == never) return never;
    return ppm_ == 0 ? local_time - offset_ : before_drift(local_time);
  }
  void set_drift(int ppm, Time now) noexcept {
    const Time shown = local(now);
    ppm_ = ppm;
    base_ = now;
    offset_ = shown - now;
  }

 private:
  static constexpr Time::rep million = 1'000'000;

  // These functions are not inlined, because few clocks drift.
  [[gnu::noinline]] Time drifted(Time world) const noexcept {
    return base_ + offset_ + (world - base_) + part(world - base_, million);
  }
  [[gnu::noinline]] Time before_drift(Time local_time) const noexcept {
    const Time span = local_time - offset_ - base_;
    Time time = base_ + span - part(span, million + ppm_);
    while (local(time) < local_time) ++time;
    while (local(time - Time{1}) >= local_time) --time;
    return time;
  }
  /// Computes span * ppm / whole without overflow.
  Time part(Time span, Time::rep whole) const noexcept {
    return span / whole * ppm_ + span % whole * ppm_ / whole;
  }

  Time::rep ppm_ = 0;
  Time base_{};
  Time offset_{};
};

}  // namespace takt::sim
