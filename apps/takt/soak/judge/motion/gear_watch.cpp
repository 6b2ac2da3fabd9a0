#include "apps/takt/soak/judge/motion/gear_watch.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace takt::soak {
namespace {

// Number of cycles with a constant difference while the axis moves.
constexpr unsigned clear_cycles = 100;
constexpr double clear_way = 50.0;  // counts by which the axis moves
constexpr double slack = 0.1;       // counts

}  // namespace

PathVerdict GearWatch::judge(const Positions& at, Time now) {
  const bool has_moved = last_own_ && *last_own_ != at.own;
  last_own_ = at.own;
  if (now < since_) return PathVerdict::on;
  if (!at.within) {
    since_ = now;
    is_locked_ = false;
    span_.reset();
    lock_at_.reset();
    return PathVerdict::on;
  }
  has_begun_ = has_begun_ || (has_moved && at.alone);
  const double difference = at.own - task_.ratio * at.leader;
  if (!lock_at_) lock_at_ = since_ + longest_phase_in(difference);
  if (keeps(difference)) {
    take(difference, at.own, now);
    return PathVerdict::on;
  }
  const bool has_to_be_locked = is_locked_ || now >= *lock_at_;
  if (has_to_be_locked) return has_begun_ ? PathVerdict::off : PathVerdict::unknown;
  span_.reset();
  if (keeps(difference)) take(difference, at.own, now);
  return PathVerdict::on;
}

Time GearWatch::longest_phase_in(double difference) const {
  const double way = task_.phase ? std::abs(difference - *task_.phase) : 0.0;
  const std::chrono::duration<double> seconds{way / task_.catch_up};
  return task_.phase_in + std::chrono::duration_cast<Time>(seconds);
}

/// A deviation is permitted, because each of the two positions is rounded to a count.
bool GearWatch::keeps(double difference) const noexcept {
  const double rounding = (1.0 + std::abs(task_.ratio)) / 2;
  if (task_.phase && std::abs(difference - *task_.phase) > rounding + slack) return false;
  if (!span_) return true;
  const double low = std::min(span_->low, difference);
  const double high = std::max(span_->high, difference);
  return high - low <= 2 * rounding + slack;
}

/// The first differences of a span may still be those of the phase-in. Therefore the span begins
/// anew when the axis is locked.
void GearWatch::take(double difference, double own, Time now) noexcept {
  if (!span_) span_ = Span{.low = difference, .high = difference, .own_low = own, .own_high = own};
  span_->low = std::min(span_->low, difference);
  span_->high = std::max(span_->high, difference);
  span_->own_low = std::min(span_->own_low, own);
  span_->own_high = std::max(span_->own_high, own);
  ++span_->cycles;
  const bool is_clear =
      span_->cycles >= clear_cycles && span_->own_high - span_->own_low >= clear_way;
  has_begun_ = has_begun_ || is_clear;
  if (is_locked_ || (!is_clear && now < *lock_at_)) return;
  is_locked_ = true;
  span_.reset();
}

}  // namespace takt::soak
