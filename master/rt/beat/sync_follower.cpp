#include "master/rt/beat/sync_follower.hpp"

#include <algorithm>
#include <chrono>

#include "eds_parser/table/waits.hpp"

namespace takt {
namespace {

constexpr int smoothing = 16;          // intervals
constexpr std::uint8_t odd_limit = 8;  // intervals in a row before the period is reported
// Number of punctual SYNCs in a row after which an early SYNC is reported again.
constexpr std::uint8_t punctual_before_report = 100;
constexpr Time longest_sync_wait = std::chrono::milliseconds{20};

}  // namespace

SyncFollower::SyncFollower(const CyclePlan& plan, EventQueue& events) noexcept
    : used_{plan.sync && plan.sync_followed},
      id_{plan.sync_cob_id},
      declared_{plan.period},
      tolerance_{plan.followed_tolerance()},
      timeout_{plan.sync_timeout},
      reaction_{plan.on_sync_loss},
      overflow_{plan.sync_overflow},
      events_{events},
      period_{plan.period} {}

Time SyncFollower::sync_wait() const noexcept {
  return std::min<Time>(declared_ / 2, longest_sync_wait);
}

Time SyncFollower::end_of_wait(Time expected) const noexcept {
  const Time end = expected + sync_wait();
  const Time lost_at = last_ ? *last_ + timeout_ : end;
  return lost_at > end && lost_at - end <= tolerance_ ? lost_at : end;
}

void SyncFollower::announce(EventKind kind, Time now, std::int64_t value,
                            std::uint32_t detail) noexcept {
  events_.push({.when = now, .kind = kind, .detail = detail, .value = value});
}

void SyncFollower::on_sync(const StampedFrame& sync) noexcept {
  const Time when = sync.when;
  if (last_ && too_early(when - *last_, when)) return;
  check_counter(sync.frame, when);
  if (last_) measure(when - *last_, when);
  place(when);
  if (state_ != State::locked) lock(when);
  last_ = when;
  arrival_ = when;
}

/// Reports an early SYNC once, until enough punctual SYNCs have come.
bool SyncFollower::too_early(Time interval, Time when) noexcept {
  if (interval >= declared_ / 2) {
    if (early_ != 0) --early_;
    return false;
  }
  if (early_ == 0) announce(EventKind::sync_early, when, interval.count());
  early_ = punctual_before_report;
  return true;
}

void SyncFollower::check_counter(const Frame& frame, Time when) noexcept {
  const bool counts = overflow_ >= 2;
  const std::int64_t got = frame.length == 0 ? -1 : frame.data[0];
  const auto expected = static_cast<std::uint8_t>(counter_ >= overflow_ ? 1 : counter_ + 1);
  const bool known = counter_ != 0 && state_ == State::locked;
  const bool in_range = counts && got >= 1 && got <= overflow_;
  const bool good = counts ? in_range && (!known || got == expected) : got < 0;
  if (!good && !jumped_) announce(EventKind::sync_jump, when, got, counts ? expected : 0U);
  jumped_ = !good;
  counter_ = in_range ? static_cast<std::uint8_t>(got) : std::uint8_t{0};
}

void SyncFollower::measure(Time interval, Time when) noexcept {
  const Time off = interval - declared_;
  if (std::chrono::abs(off) <= tolerance_) {
    period_ += (interval - period_) / smoothing;
    odd_ = 0;
    odd_reported_ = false;
    return;
  }
  odd_ = state_ == State::locked ? static_cast<std::uint8_t>(odd_ + 1) : std::uint8_t{0};
  if (odd_ < odd_limit) return;
  odd_ = 0;
  if (!std::exchange(odd_reported_, true)) announce(EventKind::sync_period, when, interval.count());
}

/// A single late SYNC was delayed somewhere and does not move the beat: its producer continues by
/// its own clock, and the next SYNC is on time. A second late SYNC in a row defines the beat.
void SyncFollower::place(Time when) noexcept {
  const std::int64_t periods = (when - beat_ + period_ / 2) / period_;
  const Time due = beat_ + std::max<std::int64_t>(periods, 1) * period_;
  const bool late = state_ == State::locked && when - due > tolerance_;
  beat_ = late && !late_ ? due : when;
  late_ = late;
}

void SyncFollower::lock(Time when) noexcept {
  const Time without = last_ ? when - *last_ : Time{};
  announce(EventKind::sync_back, when, without.count(), static_cast<std::uint32_t>(reaction_));
  state_ = State::locked;
}

void SyncFollower::on_silence(Time now, std::span<const NodeStatus> nodes) noexcept {
  if (state_ == State::lost) return;
  if (!last_) {
    const auto boots = [](const NodeStatus& node) { return node.boot == BootState::booting; };
    if (std::ranges::any_of(nodes, boots) || !idle_since_) idle_since_ = now;
  }
  const Time limit = last_ ? timeout_ : std::max<Time>(timeout_, waits::first_sync);
  if (now - (last_ ? *last_ : *idle_since_) < limit) return;
  state_ = State::lost;
  announce(EventKind::sync_lost, now, last_ ? (now - *last_).count() : 0,
           static_cast<std::uint32_t>(reaction_));
}

}  // namespace takt
