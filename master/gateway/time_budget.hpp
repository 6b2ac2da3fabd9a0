#pragma once
#include <chrono>
#include <functional>

#include "eds_parser/table/time.hpp"

namespace takt {

/// Where the front thread reads the time: CLOCK_MONOTONIC, or a clock of a test.
using FrontClock = std::function<Time()>;

/// How long one source may keep the front thread in each round. What is left over waits for the
/// next round, which begins with the images again. A source may exceed its budget by one message.
namespace front_budget {

inline constexpr Time lcm = std::chrono::microseconds{500};
inline constexpr Time broker = std::chrono::microseconds{500};
inline constexpr Time gateway = std::chrono::microseconds{250};
/// The answers of the bus thread to requests, and the files of transfers. The requests themselves
/// come from the sources above.
inline constexpr Time requests = std::chrono::microseconds{250};
/// Events of the bus thread, which may come by the hundred.
inline constexpr Time events = std::chrono::microseconds{250};

}  // namespace front_budget

/// The rest of a budget. `clock` outlives it.
class TimeBudget {
 public:
  TimeBudget(const FrontClock& clock, Time span) : clock_{clock}, end_{clock() + span} {}

  bool is_left() const { return clock_() < end_; }

 private:
  const FrontClock& clock_;
  Time end_;
};

}  // namespace takt
