#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace takt {

/// Queue of fixed capacity for use within one thread. A full queue refuses further items and counts
/// them.
template <class T, std::size_t N>
class FixedQueue {
  static_assert(N >= 2 && (N & (N - 1)) == 0);

 public:
  /// Adds an item. If the queue is full, it only counts the item.
  void push(const T& item) noexcept {
    if (head_ - tail_ == N) {
      ++lost_;
    } else {
      items_[head_++ & (N - 1)] = item;
    }
  }
  /// Takes the oldest item. Returns false if the queue is empty.
  bool pop(T& item) noexcept {
    if (head_ == tail_) return false;
    item = items_[tail_++ & (N - 1)];
    return true;
  }
  /// Returns the oldest item. The queue must not be empty.
  const T& front() const noexcept { return items_[tail_ & (N - 1)]; }
  bool empty() const noexcept { return head_ == tail_; }
  /// Returns the number of refused items.
  std::uint64_t lost() const noexcept { return lost_; }

 private:
  std::array<T, N> items_{};
  std::size_t head_ = 0;
  std::size_t tail_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace takt
