#include "master/gateway/front_gap.hpp"

#include <algorithm>
#include <chrono>

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time shortest_slack = 100ms;
constexpr Time settling = 20ms;
constexpr Time longest_backlog = 1s;
constexpr Time request_gap = 1s;

}  // namespace

FrontGap::FrontGap(Time period) noexcept : slack_{std::max(4 * period, shortest_slack)} {}

bool FrontGap::ran(Time now) noexcept {
  const bool gap = last_ != never && now > std::max(due_, last_) + slack_;
  if (gap) {
    length_ = now - last_;
    end_ = now;
    backlog_ = Backlog::possible;
    if (harms_requests(length_)) newest_long_ = {.length = length_, .end = now};
  }
  last_ = now;
  return gap;
}

bool FrontGap::discards_commands(Time now) const noexcept {
  if (end_ == Time{0}) return false;
  const Time since = now - end_;
  return since < settling || (backlog_ == Backlog::possible && since < longest_backlog);
}

bool FrontGap::discards_requests(Time now) const noexcept {
  return discards_commands(now) && harms_requests(length_);
}

bool FrontGap::harms_requests(Time length) noexcept { return length >= request_gap; }

}  // namespace takt
