#include "master/gateway/front_gap.hpp"

#include <algorithm>
#include <chrono>

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time shortest_slack = 100ms;
constexpr Time settling = 20ms;
constexpr Time request_gap = 1s;

}  // namespace

FrontGap::FrontGap(Time period) noexcept : slack_{std::max(4 * period, shortest_slack)} {}

bool FrontGap::ran(Time now) noexcept {
  const bool gap = last_ != never && now > std::max(due_, last_) + slack_;
  if (gap) {
    length_ = now - last_;
    discard_until_ = now + settling;
  }
  last_ = now;
  return gap;
}

bool FrontGap::discards_requests(Time now) const noexcept {
  return discards_commands(now) && length_ >= request_gap;
}

}  // namespace takt
