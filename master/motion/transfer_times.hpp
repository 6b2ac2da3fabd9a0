#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "master/motion/transfer.hpp"

namespace takt::motion {

/// A range of durations in s. Both ends belong to it. `last` may be infinite.
struct TimeRange {
  double first = 0.0;
  double last = 0.0;
};

/// The durations that are possible for a transfer. They can be several ranges. For example, an axis
/// that accelerates may reach the end velocity in a short time if it accelerates further, or in a
/// long time if it reverses first, but not in a time between these.
class TransferTimes {
 public:
  explicit TransferTimes(const Transfer& transfer) noexcept;

  /// Returns at least one range, in ascending order. The last range has no end.
  std::span<const TimeRange> ranges() const noexcept { return std::span{ranges_}.first(size_); }

 private:
  void add(double first, double last) noexcept { ranges_[size_++] = {first, last}; }

  std::array<TimeRange, 3> ranges_{};
  std::size_t size_ = 0;
};

}  // namespace takt::motion
