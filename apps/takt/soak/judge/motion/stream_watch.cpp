#include "apps/takt/soak/judge/motion/stream_watch.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

constexpr double tolerance = 1.0;       // counts
constexpr Time longest_arrival = 60ms;  // a message has arrived by then

}  // namespace

void StreamWatch::take(const motion_stream_t& message, Time now) {
  for (std::size_t i = 0; i < message.points.size(); ++i) {
    const auto number = static_cast<std::size_t>(message.first_point) + i;
    if (number != points_.size()) continue;
    const motion_point_t& point = message.points[i];
    points_.push_back({.time = point.time,
                       .position = point.position.front(),
                       .velocity = point.velocity.front(),
                       .sent = now});
    if (!point.acceleration.empty()) points_.back().acceleration = point.acceleration.front();
  }
}

/// The curve between two points is the polynomial of degree 5 through their positions, velocities
/// and accelerations, or of degree 3 if the second one has no acceleration.
double StreamWatch::path(double time) const {
  const auto next = std::ranges::lower_bound(points_, time, {}, &Point::time);
  if (next == points_.begin()) return points_.front().position;
  if (next == points_.end()) return points_.back().position;
  const Point& from = *(next - 1);
  const double span = next->time - from.time;
  const double s = (time - from.time) / span;
  const double v = from.velocity * span;
  const double way = next->position - from.position - v;
  const double turn = (next->velocity - from.velocity) * span;
  if (!next->acceleration) {
    return from.position + v * s + s * s * ((3 * way - turn) + s * (turn - 2 * way));
  }
  const double half = from.acceleration.value_or(0.0) * span * span / 2;
  const double a = way - half;
  const double b = turn - 2 * half;
  const double c = *next->acceleration * span * span / 2 - half;
  return from.position + v * s +
         s * s *
             (half + s * ((10 * a - 4 * b + c) +
                          s * ((7 * b - 15 * a - 2 * c) + s * (6 * a - 3 * b + c))));
}

/// Returns the time up to which the points have certainly arrived, if the stream has begun.
double StreamWatch::certain_end(Time now) const {
  double end = 0.0;
  for (const Point& point : points_) {
    if (point.sent != points_.front().sent && point.sent + longest_arrival > now) break;
    end = point.time;
  }
  return end;
}

/// Returns true if the last point ends the path at rest.
bool StreamWatch::ends() const {
  const Point& last = points_.back();
  return last.velocity == 0.0 && last.acceleration.value_or(0.0) == 0.0 && points_.size() > 1;
}

PathVerdict StreamWatch::judge(double counts, Time now) {
  const auto is_near = [&](double position) {
    return std::abs(counts - this->counts(position)) <= tolerance;
  };
  const bool in_time = cycle_ < frame_.longest_begin;
  at_start_ = at_start_ && is_near(points_.front().position);
  if (at_start_ && in_time) begins_.push_back(cycle_);
  if (begins_.empty()) return at_start_ ? PathVerdict::unknown : PathVerdict::off;
  const double newest = (cycle_ - begins_.front()) * frame_.period;
  const double certain = certain_end(now);
  const bool is_complete = ends() && certain >= points_.back().time;
  if (newest > certain && !is_complete) return PathVerdict::unknown;
  std::erase_if(begins_,
                [&](unsigned begin) { return !is_near(path((cycle_ - begin) * frame_.period)); });
  ++cycle_;
  if (begins_.empty()) {
    if (!at_start_) return PathVerdict::off;
    return in_time ? PathVerdict::on : PathVerdict::unknown;
  }
  const bool is_over = is_complete && newest > points_.back().time;
  return is_over && !at_start_ ? PathVerdict::done : PathVerdict::on;
}

}  // namespace takt::soak
