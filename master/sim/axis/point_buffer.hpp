#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "master/sim/axis/axis_objects.hpp"

namespace takt::sim {

/// The buffer of the mode interpolated position, first in, first out. A point that finds it full is
/// lost. Its size is 0x60C4:02 (or :01), at most 256 points; without these objects it is 1.
/// CiA 402-2, 0x60C1 and 0x60C4.
class PointBuffer {
 public:
  explicit PointBuffer(AxisObjects& objects) noexcept : objects_{objects} {}

  void clear() noexcept {
    count_ = 0;
    publish();
  }
  /// Returns false if the point is lost: the buffer is full, or 0x60C4:06 holds 0.
  bool add(double point) noexcept {
    if (objects_.buffer_clear.get() == 0) clear();
    if (objects_.buffer_clear.get() == 0 || count_ >= size()) return false;
    points_[(first_ + count_++) % points_.size()] = newest_ = point;
    publish();
    return true;
  }
  /// Takes the oldest point, if there is one.
  std::optional<double> take() noexcept {
    if (count_ == 0) return std::nullopt;
    const double point = points_[first_];
    first_ = (first_ + 1) % points_.size();
    --count_;
    publish();
    return point;
  }
  /// Returns the point that was added last.
  double newest() const noexcept { return newest_; }

 private:
  std::size_t size() const noexcept {
    const double own = objects_.buffer_size.positive_or(objects_.buffer_max_size.positive_or(1));
    return static_cast<std::size_t>(std::min(own, static_cast<double>(points_.size())));
  }
  void publish() noexcept { objects_.buffer_position.set(static_cast<std::int64_t>(count_)); }

  AxisObjects& objects_;
  std::array<double, 256> points_{};
  double newest_ = 0;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace takt::sim
