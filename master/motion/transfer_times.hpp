#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "master/motion/transfer.hpp"

namespace takt::motion {

/// Durations in s, both ends included. The last may be infinite.
struct TimeRange {
  double first = 0.0;
  double last = 0.0;
};

/// The durations that a transfer can have. They need not be one range: an axis that accelerates can
/// keep accelerating for a short time, or reverse, which takes a long time, but nothing in between.
class TransferTimes {
 public:
  explicit TransferTimes(const Transfer& transfer) noexcept;

  /// At least one range, in ascending order. The last one has no end.
  std::span<const TimeRange> ranges() const noexcept { return std::span{ranges_}.first(size_); }

 private:
  void add(double first, double last) noexcept { ranges_[size_++] = {first, last}; }

  std::array<TimeRange, 3> ranges_{};
  std::size_t size_ = 0;
};

}  // namespace takt::motion
