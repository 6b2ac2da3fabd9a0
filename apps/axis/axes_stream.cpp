#include <fmt/format.h>
#include <limits>

#include "apps/axis/axes_state.hpp"

// Streams: paths of points that an application gives in advance.

namespace takt {
namespace {

motion_point_t message_of(const PathPoint& point) {
  const auto numbers = [](const Eigen::VectorXd& values) {
    return std::vector<double>{values.data(), values.data() + values.size()};
  };
  motion_point_t message{};
  message.time = point.time;
  message.position = numbers(point.position);
  message.velocity = numbers(point.velocity);
  message.acceleration = numbers(point.acceleration);
  return message;
}

}  // namespace

Done Axes::State::begin_stream(const MotionBounds& bounds) {
  if (Done ready = wait_for_begin(bounds); !ready) return ready;
  if (moving()) {
    return obstacle(Obstacle::Kind::blocked, "the axes move: a stream begins at rest");
  }
  std::vector<double> positions;
  for (const Index axis : axes) positions.push_back(group.motion(axis)->position);
  stream_.emplace(Stream{
      .buffer = {positions, std::chrono::duration<double>{group.period()}.count()},
      .goals = goals_within(bounds),
  });
  return {};
}

Done Axes::State::stream(std::span<const PathPoint> points) {
  const Done given = give_points(points);
  // Only the first obstacle is reported.
  if (!given) [[maybe_unused]]
    const Done stood = stop();
  return given;
}

Done Axes::State::give_points(std::span<const PathPoint> points) {
  if (!is_current()) return restarted();
  if (!stream_) {
    return obstacle(Obstacle::Kind::wrong_use,
                    "no stream has begun, or it has ended: call begin_stream() first");
  }
  for (const PathPoint& point : points) {
    const std::string wrong = stream_->buffer.add(message_of(point));
    if (!wrong.empty()) return obstacle(Obstacle::Kind::wrong_use, wrong);
  }
  const auto over = [this] { return !stream_goes_on() || stream_->buffer.has_room(); };
  const auto waited = wait_until(over, std::chrono::nanoseconds::max());
  if (waited && !*waited) return *waited;
  if (stream_goes_on()) return {};
  if (Done end = ended(); !end) return end;
  return obstacle(Obstacle::Kind::stopped,
                  "the stream has come to rest at its last point: begin_stream() begins another");
}

/// Sends the remaining points, even if they are few.
void Axes::State::finish_stream() {
  if (!stream_) return;
  stream_->buffer.finish();
  serve_stream();
}

void Axes::State::serve_stream() {
  const std::int64_t cycle = group.input().cycle();
  if (stream_->begun && !stream_goes_on()) return;
  const auto motion = group.motion(axes.front());
  if (stream_->begun && motion && motion->id == id_) {
    stream_->buffer.observe(group.motion_cycle(axes.front()), motion->time_left);
  }
  motion_stream_t message{};
  if (!stream_->buffer.fill(cycle, message)) return;
  if (!stream_->begun) note_begin();
  stream_->begun = true;
  message.id = id_;
  message.timeout_ms = static_cast<std::int32_t>(options.timeout.count());
  message.goals = stream_->goals;
  last_sent_ = Clock::now();
  group.send_stream(message);
}

bool Axes::State::stream_goes_on() const {
  return stream_ && (!stream_->begun || is_under_way(course()));
}

double Axes::State::stream_left() const {
  if (!stream_ || !stream_->begun) return 0.0;
  double left = std::numeric_limits<double>::infinity();
  for (const Index axis : axes) {
    const auto motion = group.motion(axis);
    left = std::min(left, motion && motion->id == id_ ? motion->time_left : 0.0);
  }
  return left;
}

}  // namespace takt
