#include "apps/takt/simulate/program/stream_path.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time sent_ahead = 400ms;
constexpr double point_distance = 0.04;       // s, from point to point
constexpr std::int64_t repeated_points = 10;  // points that a message repeats
constexpr double part_of_limits = 0.9;
// The largest derivatives of the path of smallest jerk from 0 to 1 in 1 s.
constexpr double most_velocity = 1.875;
constexpr double most_acceleration = 5.7736;
constexpr double most_jerk = 60.0;

Time to_time(double seconds) {
  return std::chrono::duration_cast<Time>(std::chrono::duration<double>{seconds});
}

}  // namespace

StreamPath::StreamPath(double from, double to, const Limits& limits, Time begin)
    : from_{from}, to_{to}, begin_{begin} {
  const double way = std::abs(to - from) / part_of_limits;
  seconds_ = std::max({most_velocity * way / limits.velocity,
                       std::sqrt(most_acceleration * way / limits.acceleration),
                       std::cbrt(most_jerk * way / limits.jerk), 2 * point_distance});
  points_ = static_cast<std::int64_t>(std::ceil(seconds_ / point_distance));
}

motion_point_t StreamPath::point(std::int64_t number) const {
  const double s = static_cast<double>(number) / static_cast<double>(points_);
  const double way = to_ - from_;
  motion_point_t point{};
  point.time = s * seconds_;
  point.num_axes = point.num_accelerations = 1;
  point.position = {from_ + way * s * s * s * (10 + s * (-15 + 6 * s))};
  point.velocity = {way * 30 * s * s * (1 - s) * (1 - s) / seconds_};
  point.acceleration = {way * 60 * s * (1 - s) * (1 - 2 * s) / (seconds_ * seconds_)};
  return point;
}

void StreamPath::put_points(motion_stream_t& stream, Time now) {
  const double until = std::chrono::duration<double>(now - begin_ + sent_ahead).count();
  const auto last =
      std::min(points_, static_cast<std::int64_t>(until / seconds_ * static_cast<double>(points_)));
  stream.first_point = std::max<std::int64_t>(0, next_ - repeated_points);
  for (std::int64_t i = stream.first_point; i <= last; ++i) stream.points.push_back(point(i));
  stream.num_points = static_cast<std::int32_t>(stream.points.size());
  next_ = std::max(next_, last + 1);
}

Time StreamPath::sent_until() const noexcept {
  if (points_ <= 0) return {};
  const auto newest = static_cast<double>(std::max<std::int64_t>(next_ - 1, 0));
  return to_time(newest * seconds_ / static_cast<double>(points_));
}

Time StreamPath::duration() const noexcept { return to_time(seconds_); }

}  // namespace takt
