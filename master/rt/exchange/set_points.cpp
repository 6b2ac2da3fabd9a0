#include "master/rt/exchange/set_points.hpp"

#include <algorithm>
#include <cassert>

namespace takt {

SetPoints::SetPoints(std::size_t outputs) : staged_(outputs), handed_(outputs, 0) {
  for (SetPointFrame& frame : frames_) frame.points.resize(outputs);
}

void SetPoints::set(std::size_t output, std::int64_t value, std::uint32_t time_to_live) noexcept {
  assert(output < staged_.size());
  SetPoint& point = staged_[output];
  point.value = value;
  point.time_to_live = time_to_live;
  if (++point.generation == 0) point.generation = 1;
}

void SetPoints::publish(Time now) noexcept {
  for (std::size_t i = 0; i < staged_.size(); ++i) {
    if (staged_[i].generation == handed_[i]) continue;
    handed_[i] = staged_[i].generation;
    staged_[i].when = now;
  }
  SetPointFrame& frame = frames_[back_];
  std::ranges::copy(staged_, frame.points.begin());
  frame.when = now;
  back_ = middle_.exchange(back_ | fresh, std::memory_order_acq_rel) & 3U;
}

const SetPointFrame& SetPoints::newest() noexcept {
  if ((middle_.load(std::memory_order_relaxed) & fresh) != 0) {
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & 3U;
  }
  return frames_[front_];
}

}  // namespace takt
