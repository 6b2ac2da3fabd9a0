#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "master/core/event.hpp"

namespace takt {

/// Events of one cycle on their way to the front thread's ring. A full queue refuses and counts.
/// Bus thread only.
class EventQueue {
 public:
  static constexpr std::size_t capacity = 256;

  bool push(const Event& event) noexcept {
    if (head_ - tail_ == capacity) {
      ++lost_;
      return false;
    }
    events_[head_++ % capacity] = event;
    return true;
  }
  bool pop(Event& event) noexcept {
    if (empty()) return false;
    event = events_[tail_++ % capacity];
    return true;
  }
  bool empty() const noexcept { return head_ == tail_; }
  std::uint64_t lost() const noexcept { return lost_; }

 private:
  std::array<Event, capacity> events_{};
  std::size_t head_ = 0;
  std::size_t tail_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace takt
