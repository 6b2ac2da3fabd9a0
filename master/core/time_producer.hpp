#pragma once
#include <optional>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/time.hpp"
#include "master/core/machine.hpp"
#include "master/wire/time_of_day.hpp"

namespace takt {

/// When TIME is to be sent: at once, and then each period. CiA 301, 7.2.6. Bus thread only.
class TimeProducer {
 public:
  explicit TimeProducer(const TimePlan& plan) noexcept
      : plan_{plan}, next_{plan.period > Time{} ? at_once : never} {}

  Time deadline() const noexcept { return next_; }
  /// The frame that tells the time of day at `now`; `since_1970` is UTC minus the clock of `now`.
  /// None: the time of day is not known, or is none that the frame can hold.
  std::optional<Frame> frame(Time now, Time since_1970) const noexcept {
    if (since_1970 == Time{}) return std::nullopt;
    const auto time = time_of_day(now + since_1970);
    return time ? std::optional{time_frame(plan_.cob_id, *time)} : std::nullopt;
  }
  /// One that was late does not shift those after it.
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
