#include "master/core/node/node_guard.hpp"

#include <algorithm>

namespace takt {

void NodeGuard::start(Time now) noexcept {
  if (plan_.period <= Time{} || running()) return;
  next_request_ = silent_from_ = now;
  repeated_ = 0;
}

void NodeGuard::node_was_reset() noexcept {
  stop();
  last_toggle_ = true;  // so the next answer must have toggle bit 0
}

void NodeGuard::request_sent(Time now) noexcept {
  next_request_ += plan_.period;
  if (next_request_ <= now) next_request_ = now + plan_.period;
}

bool NodeGuard::on_answer(bool toggle, Time now) noexcept {
  if (!running()) return true;
  if (last_toggle_ == toggle) {
    ++repeated_;
    return false;
  }
  last_toggle_ = toggle;
  repeated_ = 0;
  silent_from_ = now;
  return true;
}

std::optional<Time> NodeGuard::on_time(Time now) noexcept {
  if (now < lost_at()) return std::nullopt;
  const Time silence = now - silent_from_;
  silent_from_ = never;
  last_toggle_.reset();
  return silence;
}

Time NodeGuard::deadline() const noexcept { return std::min(next_request_, lost_at()); }

}  // namespace takt
