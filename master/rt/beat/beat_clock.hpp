#pragma once
#include <cstdint>

#include "eds_parser/values/time.hpp"

namespace takt {

/// Computes the absolute deadlines of the cycles as start + k * period, so that they do not drift.
/// The clock skips missed periods and never catches up; the phase stays the same.
class BeatClock {
 public:
  explicit BeatClock(Time period) noexcept : period_{period} {}

  void start(Time first) noexcept {
    deadline_ = first;
    cycle_ = 1;
  }
  Time deadline() const noexcept { return deadline_; }
  std::uint64_t cycle() const noexcept { return cycle_; }  ///< number of the period, from 1
  Time period() const noexcept { return period_; }

  /// If a SYNC at `now` would come too close to the next deadline, moves to the next deadline in
  /// the future. Returns the number of skipped periods.
  std::uint64_t skip_missed(Time now) noexcept {
    const Time late = now - deadline_;
    if (late <= period_ / 2) return 0;
    const std::int64_t missed = (late.count() + period_.count() - 1) / period_.count();
    deadline_ += missed * period_;
    cycle_ += static_cast<std::uint64_t>(missed);
    return static_cast<std::uint64_t>(missed);
  }
  /// Follows the SYNC of another device: the beat was at `beat`, and the next one is expected one
  /// `period` later. Returns the number of periods skipped since the deadline.
  std::uint64_t follow(Time beat, Time period) noexcept {
    const std::int64_t late = (beat - deadline_ + period / 2) / period;
    const auto missed = static_cast<std::uint64_t>(late > 0 ? late : 0);
    deadline_ = beat;
    period_ = period;
    cycle_ += missed;
    return missed;
  }
  void next() noexcept {
    deadline_ += period_;
    ++cycle_;
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state.period(period_);
    state(deadline_, cycle_);
  }

 private:
  Time period_;
  Time deadline_{};
  std::uint64_t cycle_ = 0;
};

/// The counter of SYNC runs from 1 to the overflow value and counts only SYNCs that were sent. CiA
/// 301, 7.2.5.
class SyncCounter {
 public:
  /// `overflow` has the meaning of object 0x1019; below 2, SYNC has no counter.
  explicit SyncCounter(std::uint8_t overflow) noexcept : overflow_{overflow} {}
  bool used() const noexcept { return overflow_ >= 2; }
  std::uint8_t next() const noexcept { return next_; }
  void sent() noexcept { next_ = next_ >= overflow_ ? 1 : static_cast<std::uint8_t>(next_ + 1); }

  void restart() noexcept { next_ = 1; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(next_);
  }

 private:
  std::uint8_t overflow_;
  std::uint8_t next_ = 1;
};

}  // namespace takt
