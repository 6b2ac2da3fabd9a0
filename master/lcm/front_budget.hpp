#pragma once
#include <chrono>
#include <functional>

#include "eds_parser/values/time.hpp"

namespace takt {

/// The clock of the front thread: CLOCK_MONOTONIC, or a clock of a test.
using FrontClock = std::function<Time()>;

/// The time that is left in a round for one source of messages of the front thread. The remaining
/// messages wait for the next round, which begins with the images again. A source may exceed its
/// budget by one message.
class FrontBudget {
 public:
  static constexpr Time lcm = std::chrono::microseconds{500};
  static constexpr Time broker = std::chrono::microseconds{500};
  static constexpr Time gateway = std::chrono::microseconds{250};
  /// The budget for replies of the bus thread to requests, and for the files of transfers. The
  /// requests themselves come from the sources above.
  static constexpr Time requests = std::chrono::microseconds{250};
  /// The budget for events of the bus thread, of which hundreds may come at once.
  static constexpr Time events = std::chrono::microseconds{250};

  /// `clock` must outlive the budget.
  FrontBudget(const FrontClock& clock, Time span) : clock_{clock}, end_{clock() + span} {}

  bool is_left() const { return clock_() < end_; }

 private:
  const FrontClock& clock_;
  Time end_;
};

}  // namespace takt
