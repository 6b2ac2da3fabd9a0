#pragma once
#include "eds_parser/table/time.hpp"

namespace takt::sim {

/// The clock of a device, which may run slightly fast or slow. |ppm| must be below 100,000.
class LocalClock {
 public:
  Time local(Time world) const noexcept {
    if (ppm_ == 0) return world + offset_;
    return base_ + offset_ + (world - base_) + part(world - base_, million);
  }
  /// Returns the earliest world time at which the local clock shows `local_time` or more.
  Time world(Time local_time) const noexcept {
    if (local_time == never) return never;
    if (ppm_ == 0) return local_time - offset_;
    const Time span = local_time - offset_ - base_;
    Time time = base_ + span - part(span, million + ppm_);
    while (local(time) < local_time) ++time;
    while (local(time - Time{1}) >= local_time) --time;
    return time;
  }
  void set_drift(int ppm, Time now) noexcept {
    const Time shown = local(now);
    ppm_ = ppm;
    base_ = now;
    offset_ = shown - now;
  }

 private:
  static constexpr Time::rep million = 1'000'000;

  /// Computes span * ppm / whole without overflow.
  Time part(Time span, Time::rep whole) const noexcept {
    return span / whole * ppm_ + span % whole * ppm_ / whole;
  }

  Time::rep ppm_ = 0;
  Time base_{};
  Time offset_{};
};

}  // namespace takt::sim
