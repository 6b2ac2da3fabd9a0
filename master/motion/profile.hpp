#pragma once
#include <array>
#include <cstddef>
#include <span>

namespace takt::motion {

/// The position, velocity and acceleration of one axis at one moment, in the length unit of the
/// caller and in seconds.
struct State {
  double position = 0.0;
  double velocity = 0.0;
  double acceleration = 0.0;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(position, velocity, acceleration);
  }
};

/// A part of a motion during which the jerk is constant.
struct Segment {
  double duration = 0.0;  ///< s, never negative
  double jerk = 0.0;      ///< units/s^3

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(duration, jerk);
  }
};

/// Returns the state after `duration` seconds of constant jerk.
constexpr State advanced(const State& from, double duration, double jerk) noexcept {
  const double t = duration;
  return {
      .position = from.position + t * (from.velocity + t * (from.acceleration / 2 + t * jerk / 6)),
      .velocity = from.velocity + t * (from.acceleration + t * jerk / 2),
      .acceleration = from.acceleration + t * jerk};
}

/// A motion of one axis as a sequence of segments. No function allocates memory.
class Profile {
 public:
  /// At most two segments bring a state inside its limits. The motion after them has up to 14
  /// segments: it may be the weighted mean of two motions with seven segments each.
  static constexpr std::size_t capacity = 2 + 14;

  /// Appends a segment. A segment without duration is dropped.
  constexpr void add(double duration, double jerk) noexcept {
    if (duration <= 0.0 || size_ == capacity) return;
    segments_[size_++] = {.duration = duration, .jerk = jerk};
  }

  constexpr std::span<const Segment> segments() const noexcept {
    return std::span{segments_}.first(size_);
  }

  /// Returns the duration of the whole motion in s.
  constexpr double duration() const noexcept {
    double sum = 0.0;
    for (const Segment& segment : segments()) sum += segment.duration;
    return sum;
  }

  /// Returns the state `time` seconds after the start of the motion, which starts at `from`. After
  /// the end of the motion the acceleration stays as it was at the end.
  constexpr State at(const State& from, double time) const noexcept {
    State state = from;
    for (const Segment& segment : segments()) {
      if (time <= segment.duration) return advanced(state, time, segment.jerk);
      state = advanced(state, segment.duration, segment.jerk);
      time -= segment.duration;
    }
    return advanced(state, time, 0.0);
  }

  /// Returns the state at the end of the motion, which starts at `from`.
  constexpr State end(const State& from) const noexcept {
    State state = from;
    for (const Segment& segment : segments()) {
      state = advanced(state, segment.duration, segment.jerk);
    }
    return state;
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(segments_);
    state.position(size_, capacity + 1);
  }

 private:
  std::array<Segment, capacity> segments_{};
  std::size_t size_ = 0;
};

}  // namespace takt::motion
