#include "master/rt/journal/replay_port.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace takt {
namespace {

using What = ReplayDifference::What;

constexpr Time step = std::chrono::microseconds{1};  // step of the clock after a difference
constexpr std::uint64_t latest = journal::payload_mask;

}  // namespace

ReplayPort::ReplayPort(std::span<const Recording> parts, std::size_t outputs) : parts_{parts} {
  points_.points.resize(outputs);
  if (!parts_.empty()) begin_part();
}

void ReplayPort::begin_part() const noexcept {
  words_ = parts_[part_].words;
  frames_ = parts_[part_].frames;
  at_ = 0;
  condition_ = {};  // each recording contains everything that differs from this state
}

void ReplayPort::differ(ReplayDifference difference) const noexcept {
  if (difference_) return;
  difference.cycle = cycle_;
  difference.when = now_;
  difference.part = part_;
  difference_ = difference;
}

/// Skips a checkpoint. The records behind it repeat the whole state.
void ReplayPort::pass_checkpoint() const noexcept {
  const std::uint64_t count = journal::payload_of(words_[at_++]);
  std::span<const std::uint64_t> words;
  take(count, words);
  condition_ = {};
}

bool ReplayPort::comes(Mark mark) const noexcept {
  while (!over()) {
    if (at_ == words_.size()) {
      ++part_;
      begin_part();
    } else if (journal::mark_of(words_[at_]) == Mark::checkpoint) {
      pass_checkpoint();
    } else {
      break;
    }
  }
  return !over() && journal::mark_of(words_[at_]) == mark;
}

/// Returns the payload of the next record. Returns std::nullopt if it is another record or the
/// replay is over.
std::optional<std::uint64_t> ReplayPort::next(Mark mark) const noexcept {
  if (!comes(mark)) {
    if (over()) return std::nullopt;
    const Mark recorded = journal::mark_of(words_[at_]);
    const What what = recorded == Mark::gap ? What::missing : What::call;
    differ({.what = what, .recorded = recorded, .asked = mark});
    return std::nullopt;
  }
  return journal::payload_of(words_[at_++]);
}

bool ReplayPort::take(std::size_t count, std::span<const std::uint64_t>& words) const noexcept {
  if (difference_) return false;
  if (count > words_.size() - at_) {
    differ({.what = What::broken});
    return false;
  }
  words = words_.subspan(at_, count);
  at_ += count;
  return true;
}

/// Takes a time that is small enough for sums and differences.
bool ReplayPort::take_time(Time& time) const noexcept {
  std::span<const std::uint64_t> word;
  if (!take(1, word)) return false;
  if (word[0] > latest) {
    differ({.what = What::broken});
    return false;
  }
  time = Time{static_cast<std::int64_t>(word[0])};
  return true;
}

const Frame* ReplayPort::take_frame(std::size_t& number) const noexcept {
  std::span<const std::uint64_t> word;
  if (!take(1, word)) return nullptr;
  number = word[0];
  if (number < frames_.size()) return &frames_[number];
  differ({.what = What::broken});
  return nullptr;
}

Time ReplayPort::now() noexcept {
  const auto time = next(Mark::now);
  now_ = time ? Time{static_cast<std::int64_t>(*time)} : now_ + step;
  return now_;
}

void ReplayPort::sleep_until(Time until) noexcept {
  if (over()) now_ = std::max(now_, until);
}

bool ReplayPort::wait_frame(Time until) noexcept {
  const auto there = next(Mark::wait);
  if (there) return *there != 0;
  now_ = std::max(now_, until);
  return false;
}

std::size_t ReplayPort::receive(std::span<StampedFrame> in) noexcept {
  const auto count = next(Mark::receive);
  if (!count) return 0;
  if (*count > in.size()) {
    differ({.what = What::broken});
    return 0;
  }
  for (std::size_t i = 0; i < *count; ++i) {
    std::size_t number = 0;
    Time when{};
    const Frame* const frame = take_time(when) ? take_frame(number) : nullptr;
    if (frame == nullptr) return 0;
    in[i] = {.frame = *frame, .when = when};
  }
  return *count;
}

SendResult ReplayPort::send(std::span<const Frame> out) noexcept {
  const auto payload = next(Mark::send);
  if (!payload) return {.sent = out.size()};
  const auto recorded = journal::SendPayload::of(*payload);
  const std::size_t sent = std::min<std::size_t>(recorded.sent, out.size());
  for (std::size_t i = 0; i < sent; ++i) {
    std::size_t number = 0;
    const Frame* const frame = take_frame(number);
    if (frame == nullptr) break;
    if (*frame == out[i]) continue;
    differ({.what = What::frame, .sent = out[i], .expected = *frame, .line = number});
  }
  if (recorded.offered != out.size() || recorded.sent > recorded.offered) {
    differ({.what = What::count, .counted = out.size(), .counted_before = recorded.offered});
  }
  return {.sent = sent, .error = recorded.error};
}

PortCondition ReplayPort::condition() const noexcept {
  const auto parts = next(Mark::condition);
  if (!parts) return condition_;
  if ((*parts & journal::echo) != 0) take_time(condition_.last_sync_echo);
  std::span<const std::uint64_t> words;
  if ((*parts & journal::utc) != 0 && take(1, words)) {
    // The producer of TIME rejects a time of day out of its range; the clamp only keeps sums within
    // the range of Time.
    const auto utc = static_cast<std::int64_t>(words[0]);
    constexpr std::int64_t limit = std::int64_t{1} << 61;
    condition_.since_1970 = Time{std::clamp(utc, -limit, limit)};
  }
  if ((*parts & journal::state) != 0 && take(journal::state_words, words)) {
    journal::get_state(words.data(), condition_);
  }
  return condition_;
}

void ReplayPort::begin_cycle(std::uint64_t cycle) noexcept {
  cycle_ = cycle;
  const auto recorded = next(Mark::cycle);
  if (recorded && *recorded != (cycle & journal::payload_mask)) {
    differ({.what = What::cycle, .counted = cycle, .counted_before = *recorded});
  }
}

const SetPointFrame& ReplayPort::set_points() noexcept {
  const auto count = next(Mark::set_points);
  if (!count || *count == 0) return points_;
  std::span<const std::uint64_t> words;
  constexpr std::size_t each = sizeof(SetPoint) / 8;
  if (*count != points_.points.size()) {
    differ({.what = What::count, .counted = points_.points.size(), .counted_before = *count});
  } else if (take_time(points_.when) && take(*count * each, words)) {
    std::memcpy(static_cast<void*>(points_.points.data()), words.data(), words.size_bytes());
    for (SetPoint& point : points_.points) {
      point.when = std::clamp(point.when, Time{0}, Time{latest});
    }
  }
  return points_;
}

bool ReplayPort::take_request(Request& request) noexcept {
  if (!comes(Mark::request)) return false;
  const std::uint64_t count = next(Mark::request).value_or(0);
  std::span<const std::uint64_t> words;
  if (!take(count, words)) return false;
  if (get_request(words, request, transfers_)) return true;
  differ({.what = What::broken});
  return false;
}

bool ReplayPort::take_motion(motion::MotionMessage& message) noexcept {
  if (!comes(Mark::motion)) return false;
  const std::uint64_t count = next(Mark::motion).value_or(0);
  std::span<const std::uint64_t> words;
  if (!take(count, words)) return false;
  if (get_motion(words, message)) return true;
  differ({.what = What::broken});
  return false;
}

bool ReplayPort::stop_requested() noexcept {
  return comes(Mark::stop) && next(Mark::stop).has_value();
}

bool ReplayPort::give_reply() noexcept {
  return !(comes(Mark::replies_full) && next(Mark::replies_full));
}

void ReplayPort::note_event() noexcept { next(Mark::event); }

}  // namespace takt
