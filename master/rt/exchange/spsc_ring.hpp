#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace takt {

/// Ring between exactly one producer thread and one consumer thread. Wait-free. A full ring refuses
/// items and counts them. N is a power of two.
template <class T, std::size_t N>
class SpscRing {
  static_assert(std::is_trivially_copyable_v<T>);
  static_assert(N >= 2 && (N & (N - 1)) == 0);

 public:
  /// Producer. Returns false if the ring is full; the item is lost and counted.
  bool push(const T& item) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_seen_ == N) {
      tail_seen_ = tail_.load(std::memory_order_acquire);
      if (head - tail_seen_ == N) {
        overruns_.fetch_add(1, std::memory_order_relaxed);
        return false;
      }
    }
    items_[head & (N - 1)] = item;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  /// Producer. Returns true if the next push would be refused.
  bool full() noexcept { return !has_room(1); }
  /// Producer. Returns true if the ring has room for this number of items, at most N.
  bool has_room(std::size_t items) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_seen_ > N - items) tail_seen_ = tail_.load(std::memory_order_acquire);
    return head - tail_seen_ <= N - items;
  }

  /// Consumer. Returns false if the ring is empty.
  bool pop(T& item) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return false;
    item = items_[tail & (N - 1)];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  /// Returns the number of items refused so far. Any thread.
  std::uint64_t overruns() const noexcept { return overruns_.load(std::memory_order_relaxed); }

 private:
  alignas(64) std::atomic<std::size_t> head_{0};
  std::size_t tail_seen_ = 0;  // producer only
  alignas(64) std::atomic<std::size_t> tail_{0};
  alignas(64) std::atomic<std::uint64_t> overruns_{0};
  std::array<T, N> items_{};
};

}  // namespace takt
