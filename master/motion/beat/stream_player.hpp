#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "master/motion/beat/stream.hpp"

namespace takt::motion {

/// Leads an axis from point to point of a stream, at times that only increase. It holds a bounded
/// number of points and allocates no memory.
class StreamPlayer {
 public:
  /// Number of points that it holds, besides the point that was passed last.
  static constexpr std::size_t capacity = 64;

  /// Begins another stream, which the id of its order identifies.
  void begin(std::uint32_t order, const State& from) noexcept {
    order_ = order;
    passed_ = last_ = {.time = 0.0, .state = from};
    first_ = size_ = 0;
    tail_ = Tail::open;
  }
  std::uint32_t order() const noexcept { return order_; }
  /// Appends a point. Returns false if it is not later than the last one, if one of its numbers is
  /// not finite, or if there is no room. The stream then ends before this point and takes no later
  /// point, because the curve over the gap was not checked.
  bool add(const StreamPoint& point) noexcept;
  /// Returns the state at a time. After the last point, returns the state at that point.
  State at(double time) noexcept;
  /// Returns the last point.
  const StreamPoint& last() const noexcept { return last_; }
  /// Returns the number of points that wait.
  std::size_t size() const noexcept { return size_; }

  /// Keeps only the points that wait, so the number of words changes with size().
  template <class Archive>
  void keep(Archive& state) noexcept {
    state(order_, passed_, last_, segment_, tail_);
    state.position(first_, capacity);
    state.position(size_, capacity + 1);
    for (std::size_t i = 0; i < size_; ++i) state(points_[(first_ + i) % capacity]);
  }

 private:
  /// States whether the stream takes more points.
  enum class Tail : std::uint8_t { open, cut };

  std::uint32_t order_ = 0;  ///< 0 before the first stream
  StreamPoint passed_;       ///< the newest point that was passed
  StreamPoint last_;
  StreamSegment segment_;  ///< segment from the point that was passed to the first point that waits
  std::array<StreamPoint, capacity> points_{};
  std::size_t first_ = 0;  ///< first of the points that wait, in a ring
  std::size_t size_ = 0;
  Tail tail_ = Tail::open;
};

}  // namespace takt::motion
