#pragma once
#include <cstdint>
#include <takt/motion_stream_t.hpp>

#include "eds_parser/values/time.hpp"

namespace takt {

/// A path of one axis from rest to rest with the smallest jerk, which a program sends as points of
/// a motion_stream_t, 400 ms in advance.
class StreamPath {
 public:
  /// Limits that the path has to keep, in the unit of the axis and seconds. All are above 0.
  struct Limits {
    double velocity = 0.0;
    double acceleration = 0.0;
    double jerk = 0.0;
  };

  /// A path that is over.
  StreamPath() = default;
  /// A path of 90 % of the limits, whose first message is sent at `begin`.
  StreamPath(double from, double to, const Limits& limits, Time begin);

  /// Puts the points that are due at `now` into the message, and ten that were sent before.
  void put_points(motion_stream_t& stream, Time now);
  bool is_over() const noexcept { return next_ > points_; }
  /// Returns the time of the newest point that was sent, from point 0 on.
  Time sent_until() const noexcept;
  /// Returns the time of the last point.
  Time duration() const noexcept;

 private:
  motion_point_t point(std::int64_t number) const;

  double from_ = 0.0;
  double to_ = 0.0;
  double seconds_ = 0.0;      // time of the last point
  std::int64_t points_ = -1;  // number of the last point
  std::int64_t next_ = 0;     // first point that was not sent
  Time begin_{};
};

}  // namespace takt
