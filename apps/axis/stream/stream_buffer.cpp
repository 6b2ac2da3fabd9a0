#include "apps/axis/stream/stream_buffer.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace takt {
namespace {

/// Shortest time between two messages with new points in seconds, as long as enough points wait.
constexpr double shortest_pause = 0.02;
/// Time after which the newest message is repeated. Shortly before the points end, it is not
/// repeated, because the stream would be over when the message arrives.
constexpr double repetition_pause = 0.05;
constexpr double last_repetition = 0.1;
constexpr std::int64_t last_repetition_cycles = 10;

}  // namespace

StreamBuffer::StreamBuffer(const std::vector<double>& positions, double period) : period_{period} {
  motion_point_t start{};
  start.num_axes = static_cast<std::int32_t>(positions.size());
  start.position = positions;
  start.velocity.assign(positions.size(), 0.0);
  start.num_accelerations = start.num_axes;
  start.acceleration = start.velocity;
  points_.push_back(std::move(start));
}

std::string StreamBuffer::add(motion_point_t point) {
  const motion_point_t& last = points_.back();
  const std::size_t axes = last.position.size();
  const std::int64_t number = has_points() || point.time != 0.0 ? end() : 0;
  if (point.position.size() != axes || point.velocity.size() != axes ||
      (!point.acceleration.empty() && point.acceleration.size() != axes)) {
    return fmt::format(
        "point {} of the stream needs one position and one velocity for each of {} axes, and "
        "either one acceleration for each axis or no acceleration",
        number, axes);
  }
  if (number > 0 && !(point.time > last.time && point.time <= last.time + longest_step)) {
    return fmt::format(
        "point {} of the stream is at {} s: it must be later than the point before, which is at "
        "{} s, by {} s at most",
        number, point.time, last.time, longest_step);
  }
  point.num_axes = static_cast<std::int32_t>(axes);
  point.num_accelerations = static_cast<std::int32_t>(point.acceleration.size());
  if (number == 0) points_.pop_back();
  points_.push_back(std::move(point));
  return {};
}

/// The report does not say which of the sent points is the last one that the bus thread has. The
/// time of the stream is the time of that point minus `time_left`. The function takes the newest
/// sent point for which this time does not advance faster than the cycles.
void StreamBuffer::observe(std::int64_t cycle, double time_left) noexcept {
  const double latest = passed_ + (static_cast<double>(cycle - passed_cycle_) + 0.5) * period_;
  for (std::int64_t number = next_ - 1; number >= first_; --number) {
    const double time = time_of(number) - time_left;
    if (time > latest) continue;
    passed_ = std::max(time, 0.0);
    passed_cycle_ = cycle;
    return;
  }
}

bool StreamBuffer::fill(std::int64_t cycle, motion_stream_t& message) {
  forget_reached();
  if (!has_room()) starts_ = true;
  const Due what = due(cycle);
  if (what == Due::nothing) return false;
  if (next_ == 0) passed_cycle_ = cycle;
  while (next_ < end() && is_open(next_)) ++next_;
  sent_cycle_ = cycle;
  message.first_point = first_;
  message.points.assign(points_.begin(), points_.begin() + (next_ - first_));
  message.num_points = static_cast<std::int32_t>(message.points.size());
  return true;
}

bool StreamBuffer::has_room() const noexcept { return is_open(end()); }

std::int64_t StreamBuffer::waiting_before(std::int64_t number) const noexcept {
  const bool reached = points_.front().time <= passed_;
  return std::max<std::int64_t>(number - first_ - (reached ? 1 : 0), 0);
}

bool StreamBuffer::is_open(std::int64_t number) const noexcept {
  if (number == 0) return true;
  // Half a cycle is more than the rounding errors of the times.
  return time_of(number - 1) - passed_ < lead - period_ / 2 &&
         waiting_before(number) < most_waiting;
}

void StreamBuffer::forget_reached() {
  while (first_ + 1 < next_ && points_[1].time <= passed_) {
    points_.pop_front();
    ++first_;
  }
}

StreamBuffer::Due StreamBuffer::due(std::int64_t cycle) const noexcept {
  if (!starts_ || !has_points()) return Due::nothing;
  if (next_ == 0) return Due::new_points;
  const double left = time_of(next_ - 1) - passed_;
  const double pause = static_cast<double>(cycle - sent_cycle_) * period_;
  if (next_ < end() && is_open(next_)) {
    const bool few = left < lead / 2 && waiting_before(next_) < most_waiting / 2;
    if (few || pause >= shortest_pause) return Due::new_points;
  }
  const bool ends = left < std::max(last_repetition, last_repetition_cycles * period_);
  return !ends && pause >= repetition_pause ? Due::repetition : Due::nothing;
}

}  // namespace takt
