#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "master/motion/polynomial.hpp"
#include "master/motion/profile.hpp"

namespace takt::motion {

/// The shape of the motion to a point of a stream.
enum class Curve : std::uint8_t {
  quintic,  ///< reaches the position, velocity and acceleration of the point
  cubic,    ///< reaches its position and velocity; the acceleration follows from them, and jumps at
            ///< the point
};

/// The state that an axis must have at a given time.
struct StreamPoint {
  static constexpr std::size_t kept_words = 5;  ///< number of words of keep()

  double time = 0.0;  ///< s since the start of the stream
  State state;
  Curve curve = Curve::quintic;

  template <class Archive>
  void keep(Archive& archive) noexcept {
    archive(time, state, curve);
  }
};

/// Returns false if a number of the point is infinite or NaN.
inline bool is_finite(const StreamPoint& point) noexcept {
  return std::isfinite(point.time) && std::isfinite(point.state.position) &&
         std::isfinite(point.state.velocity) && std::isfinite(point.state.acceleration);
}

/// The motion from one point of a stream to the next. Both points alone determine its states, so
/// that the front thread can check what the bus thread will do.
class StreamSegment {
 public:
  StreamSegment() noexcept = default;
  /// `to` must be later than `from`.
  StreamSegment(const StreamPoint& from, const StreamPoint& to) noexcept
      : begin_{from.time},
        duration_{to.time - from.time},
        position_{to.curve == Curve::cubic ? cubic_between(from.state, to.state, duration_)
                                           : quintic_between(from.state, to.state, duration_)} {}

  /// Returns the state at a time of the stream.
  State at(double time) const noexcept {
    const double t = time - begin_;
    const Polynomial velocity = derivative_of(position_);
    return {.position = value_at(position_, t),
            .velocity = value_at(velocity, t),
            .acceleration = value_at(derivative_of(velocity), t)};
  }
  /// Returns the position as a function of the time since the start of the segment.
  const Polynomial& position() const noexcept { return position_; }
  double begin() const noexcept { return begin_; }        ///< s
  double duration() const noexcept { return duration_; }  ///< s

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(begin_, duration_, position_);
  }

 private:
  double begin_ = 0.0;
  double duration_ = 0.0;
  Polynomial position_{};
};

/// Returns the point `to` with the acceleration that the axis has there. The point of a cubic curve
/// does not contain this acceleration.
inline StreamPoint reached(const StreamPoint& from, const StreamPoint& to) noexcept {
  StreamPoint point = to;
  if (to.curve == Curve::cubic) {
    point.state.acceleration = StreamSegment{from, to}.at(to.time).acceleration;
  }
  return point;
}

/// Some points of a stream, in their order. Plain data.
struct StreamPoints {
  static constexpr std::size_t capacity = 8;

  std::uint32_t order = 0;  ///< id of the order of the stream
  std::uint8_t size = 0;
  std::array<StreamPoint, capacity> points{};

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(order, points);
    state.position(size, capacity + 1);
  }
};

}  // namespace takt::motion
