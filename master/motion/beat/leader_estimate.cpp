#include "master/motion/beat/leader_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace takt::motion {

/// Adds the shortest distance from the last sample to this one. Returns the number of counts since
/// the first sample.
double LeaderEstimate::counted(std::int64_t counts, const GearTask& task) noexcept {
  const unsigned unused = 64U - std::clamp<unsigned>(task.bits, 1U, 64U);
  const std::uint64_t raw = static_cast<std::uint64_t>(counts) - static_cast<std::uint64_t>(last_);
  const std::int64_t way = static_cast<std::int64_t>(raw << unused) >> unused;
  double change = static_cast<double>(way);
  if (task.modulo > 0.0) change -= task.modulo * std::round(change / task.modulo);
  last_ = counts;
  total_ += change;
  return total_;
}

void LeaderEstimate::take(const LeaderSample& sample, const GearTask& task, double time,
                          double period) noexcept {
  lost_ = sample.age == LeaderSample::Age::lost;
  const bool fresh = sample.age == LeaderSample::Age::fresh;
  missing_ = fresh ? 0 : static_cast<std::uint8_t>(std::min(missing_ + 1, +most_missing));
  if (!begun_) {
    if (!fresh) return;
    begun_ = true;
    last_ = sample.counts;
    origin_ = static_cast<double>(sample.counts) * task.scale + task.zero;
    return;
  }
  elapsed_ += time;
  const double filter = std::max(task.filter_time, shortest_filter * period);
  if (!ready_) {
    if (!fresh) return;
    const double position = counted(sample.counts, task) * task.scale;
    if (elapsed_ < filter) return;
    state_ = {.position = position, .velocity = position / elapsed_};
    ready_ = true;
    return;
  }
  const double rate = 1.0 / filter;
  state_ = advanced(state_, time, jerk_);
  const double error = fresh ? counted(sample.counts, task) * task.scale - state_.position : 0.0;
  const double pull = state_.acceleration / (rate * rate);
  jerk_ = rate * rate * rate * (4.0 * (error - pull) + slope_);
  slope_ += time * rate * (error - 6.0 * pull);
}

State LeaderEstimate::state(const GearTask& task) const noexcept {
  State state = advanced(state_, task.lead, jerk_);
  state.position += origin_;
  return state;
}

}  // namespace takt::motion
