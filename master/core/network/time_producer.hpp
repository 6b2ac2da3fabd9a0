#pragma once
#include <optional>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/values/time.hpp"
#include "master/core/machine.hpp"
#include "master/wire/time_of_day.hpp"

namespace takt {

/// Produces TIME: it is due at once, and then once in each period. CiA 301, 7.2.6. Bus thread only.
class TimeProducer {
 public:
  explicit TimeProducer(const TimePlan& plan) noexcept
      : plan_{plan}, next_{plan.period > Time{} ? at_once : never} {}

  Time deadline() const noexcept { return next_; }
  /// Returns the frame with the time of day at `now`. `since_1970` is the difference between UTC
  /// and the clock of `now`; 0 means unknown. Returns std::nullopt if the time of day is unknown,
  /// or if the frame cannot represent it.
  std::optional<Frame> frame(Time now, Time since_1970) const noexcept {
    if (since_1970 == Time{}) return std::nullopt;
    const auto time = time_of_day(now + since_1970);
    return time ? std::optional{time_frame(plan_.cob_id, *time)} : std::nullopt;
  }
  /// Notes that TIME was sent. A late TIME does not shift the following ones.
  void sent(Time now) noexcept {
    const bool in_step = next_ != at_once && next_ + plan_.period > now;
    next_ = (in_step ? next_ : now) + plan_.period;
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(next_);
  }

 private:
  TimePlan plan_;
  Time next_;
};

}  // namespace takt
