#include "master/gateway/motion/motion_streams.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "master/gateway/motion/motion_text.hpp"
#include "master/motion/planner/stream_check.hpp"

namespace takt {
namespace {

bool has_axis(const std::vector<motion::AxisGoal>& goals, std::uint8_t axis) {
  return std::ranges::find(goals, axis, &motion::AxisGoal::axis) != goals.end();
}

motion::StreamPoint stream_point(const motion_point_t& point, std::size_t axis, double time) {
  const bool quintic = !point.acceleration.empty();
  return {.time = time,
          .state = {.position = point.position[axis],
                    .velocity = point.velocity[axis],
                    .acceleration = quintic ? point.acceleration[axis] : 0.0},
          .curve = quintic ? motion::Curve::quintic : motion::Curve::cubic};
}

}  // namespace

void MotionStreams::begin(const MotionJob& job, double first_time) {
  std::erase_if(streams_, [&](const Stream& older) {
    return std::ranges::any_of(
        job.goals, [&](const motion::AxisGoal& goal) { return has_axis(older.goals, goal.axis); });
  });
  Stream stream{.id = job.name.id,
                .instance = job.instance,
                .order = job.order,
                .begin = job.begin,
                .first_time = first_time,
                .goals = job.goals};
  for (std::size_t i = 0; i < job.orders.size(); ++i) {
    const motion::MotionOrder& order = job.orders[i];
    stream.turns.push_back(turns_to(job.goals[i], order.from.position));
    stream.last.push_back({.time = 0.0, .state = order.from});
    motion::MotionMessage message{.kind = motion::MessageKind::points, .axis = order.axis};
    message.points.order = order.id;
    stream.filling.push_back(message);
  }
  streams_.push_back(std::move(stream));
}

const MotionStreams::Stream* MotionStreams::find(std::int64_t instance,
                                                 std::int32_t id) const noexcept {
  const auto found = std::ranges::find_if(streams_, [&](const Stream& stream) {
    return stream.instance == instance && stream.id == id;
  });
  return found == streams_.end() ? nullptr : &*found;
}

bool MotionStreams::has_axes(std::int64_t instance, std::int32_t id,
                             std::span<const std::size_t> axes) const noexcept {
  const Stream* stream = find(instance, id);
  return stream != nullptr && std::ranges::equal(stream->goals, axes, {}, &motion::AxisGoal::axis);
}

/// Drops the streams that have ended or did not begin. An order begins exactly in its cycle, or
/// never. Missing beats delay a stream that runs.
void MotionStreams::observe(const MotionSnapshot& snapshot) {
  std::erase_if(streams_, [&](Stream& stream) {
    const motion::AxisReport& axis = snapshot.axes[stream.goals.front().axis];
    const bool runs = axis.running == stream.order;
    if (runs) stream.begin = axis.began;
    return snapshot.cycle >= stream.begin && !runs;
  });
}

std::optional<MotionRefusal> MotionStreams::add(const motion_stream_t& message, std::uint64_t cycle,
                                                std::uint64_t reported) {
  const auto found = std::ranges::find_if(streams_, [&](const Stream& stream) {
    return stream.instance == message.instance && stream.id == message.id;
  });
  if (found == streams_.end()) return std::nullopt;
  Stream& stream = *found;
  const double now = time_of(stream, cycle);
  const double passed = time_of(stream, reported);
  while (!stream.times.empty() && stream.times.front() <= passed) stream.times.pop_front();
  if (message.first_point > stream.next) {
    return MotionRefusal{.why = fmt::format("its point {} is missing: the message begins with {}",
                                            stream.next, message.first_point)};
  }
  std::optional<MotionRefusal> refused;
  for (std::size_t i = 0; i < message.points.size() && !refused; ++i) {
    if (message.first_point + static_cast<std::int64_t>(i) < stream.next) continue;
    refused = add_point(stream, message.points[i], now);
    if (refused) refused->why = fmt::format("its point {}: {}", stream.next, refused->why);
    if (!refused) ++stream.next;
  }
  close(stream);
  hand_over(stream);
  return refused;
}

std::optional<MotionRefusal> MotionStreams::add_point(Stream& stream, const motion_point_t& point,
                                                      double now) {
  const std::size_t axes = stream.goals.size();
  const auto fits = [&](const auto& numbers) { return numbers.size() == axes; };
  if (!fits(point.position) || !fits(point.velocity) ||
      !(fits(point.acceleration) || point.acceleration.empty())) {
    return MotionRefusal{.why =
                             "it needs one position and one velocity for each axis, and either one "
                             "acceleration for each axis or no acceleration"};
  }
  if (stream.times.size() == motion::StreamPlayer::capacity) {
    return MotionRefusal{.why = fmt::format("{} points wait already", stream.times.size())};
  }
  const double time = point.time - stream.first_time;
  if (time > now + longest_ahead) {
    return MotionRefusal{.why = fmt::format("it is more than {} s in the future", longest_ahead)};
  }
  if (stream.last.front().time < now) {
    return MotionRefusal{.why = "it is too late: the points before it have ended"};
  }
  const double most = longest_step / static_cast<double>(axes);
  if (time - stream.last.front().time > most * period_) {
    return MotionRefusal{.why = fmt::format("its time is more than {:.0f} cycles after that of the "
                                            "point before ({:.0f} divided by the number of axes)",
                                            std::floor(most), longest_step)};
  }
  std::vector<motion::StreamPoint> next;
  for (std::size_t i = 0; i < axes; ++i) {
    next.push_back(stream_point(point, i, time));
    next.back().state.position += stream.turns[i];
  }
  if (const auto defect = defect_of(stream, next)) return defect;
  if (stream.filling.front().points.size == motion::StreamPoints::capacity) close(stream);
  for (std::size_t i = 0; i < axes; ++i) {
    motion::StreamPoints& points = stream.filling[i].points;
    points.points[points.size++] = stream.last[i] = motion::reached(stream.last[i], next[i]);
  }
  stream.times.push_back(time);
  return std::nullopt;
}

/// Checks the curves of all axes first, because the check of the stops takes much longer.
std::optional<MotionRefusal> MotionStreams::defect_of(
    const Stream& stream, std::span<const motion::StreamPoint> next) const {
  for (const auto check : {motion::defect_of_way, motion::defect_of_stops}) {
    for (std::size_t i = 0; i < next.size(); ++i) {
      const motion::AxisGoal& goal = stream.goals[i];
      const auto defect = check(stream.last[i], next[i],
                                {.limits = goal.limits, .range = goal.range, .period = period_});
      if (defect) return MotionRefusal{.why = std::string{text(*defect)}, .axis = goal.axis};
    }
  }
  return std::nullopt;
}

/// Appends the messages that are being filled to those that wait.
void MotionStreams::close(Stream& stream) {
  for (motion::MotionMessage& message : stream.filling) {
    if (message.points.size != 0) stream.waiting.push_back(message);
    message.points.size = 0;
  }
}

void MotionStreams::hand_over(Stream& stream) {
  while (!stream.waiting.empty() && submit_(stream.waiting.front())) stream.waiting.pop_front();
}

void MotionStreams::serve() {
  for (Stream& stream : streams_) hand_over(stream);
}

}  // namespace takt
