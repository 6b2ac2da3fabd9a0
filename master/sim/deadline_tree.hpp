#pragma once
#include <cstddef>
#include <vector>

#include "eds_parser/values/time.hpp"

namespace takt::sim {

/// A tournament tree that finds the earliest deadline: a query takes O(1), a change O(log n).
class DeadlineTree {
 public:
  explicit DeadlineTree(std::size_t count) {
    while (leaves_ < count) leaves_ *= 2;
    times_.assign(2 * leaves_, never);
  }

  void set(std::size_t index, Time time) noexcept {
    std::size_t at = leaves_ + index;
    if (times_[at] == time) return;
    times_[at] = time;
    while (at > 1) {
      at /= 2;
      const Time winner =
          times_[2 * at] <= times_[2 * at + 1] ? times_[2 * at] : times_[2 * at + 1];
      if (times_[at] == winner) return;
      times_[at] = winner;
    }
  }
  Time earliest() const noexcept { return times_[1]; }
  /// Returns the index with the earliest deadline; of equal deadlines, the lowest index.
  std::size_t first() const noexcept {
    std::size_t at = 1;
    while (at < leaves_) at = 2 * at + (times_[2 * at] <= times_[2 * at + 1] ? 0 : 1);
    return at - leaves_;
  }

 private:
  std::size_t leaves_ = 1;
  std::vector<Time> times_;
};

}  // namespace takt::sim
