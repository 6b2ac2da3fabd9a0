#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// A frame that waits for the wire.
struct QueuedFrame {
  Frame frame{};
  std::uint32_t rank = 0;   ///< rank in arbitration; the lowest wins
  std::uint16_t bits = 0;   ///< length on the wire without interframe space
  bool repetition = false;  ///< a fault has made this copy
  Time ready{};
  Time expires = never;
};

/// Frames in the order of their arrival. Taking the first frame moves no other frame. Nothing
/// allocates memory after construction.
class FrameQueue {
 public:
  explicit FrameQueue(std::size_t capacity) : frames_(capacity), capacity_{capacity} {}

  bool empty() const noexcept { return first_ == end_; }
  std::size_t size() const noexcept { return end_ - first_; }
  bool full() const noexcept { return size() == capacity_; }
  const QueuedFrame& operator[](std::size_t position) const noexcept {
    return frames_[first_ + position];
  }
  auto begin() const noexcept { return frames_.begin() + static_cast<std::ptrdiff_t>(first_); }
  auto end() const noexcept { return frames_.begin() + static_cast<std::ptrdiff_t>(end_); }

  /// Appends a frame and returns it. The caller has to overwrite all of it, because it still has
  /// the data of an earlier frame. Requires that the queue is not full.
  QueuedFrame& push_back() noexcept {
    if (end_ == capacity_) close_gap();
    return frames_[end_++];
  }
  /// Requires that the queue is not full.
  void push_front(const QueuedFrame& frame) noexcept {
    if (first_ == 0) {
      std::copy_backward(begin(), end(), at(end_ + 1));
      ++end_;
    } else {
      --first_;
    }
    frames_[first_] = frame;
  }
  QueuedFrame take(std::size_t position) noexcept {
    const QueuedFrame frame = (*this)[position];
    if (position != 0) {
      std::copy(at(first_ + position + 1), at(end_), at(first_ + position));
      --end_;
    } else if (++first_ == end_) {
      clear();
    }
    return frame;
  }
  template <class Condition>
  std::size_t erase_if(Condition condition) noexcept {
    const auto kept = std::remove_if(at(first_), at(end_), condition);
    const auto erased = static_cast<std::size_t>(at(end_) - kept);
    end_ -= erased;
    return erased;
  }
  void clear() noexcept { first_ = end_ = 0; }

 private:
  std::vector<QueuedFrame>::iterator at(std::size_t position) noexcept {
    return frames_.begin() + static_cast<std::ptrdiff_t>(position);
  }
  void close_gap() noexcept {
    std::copy(at(first_), at(end_), at(0));
    end_ -= first_;
    first_ = 0;
  }

  std::vector<QueuedFrame> frames_;
  std::size_t capacity_;   ///< size of `frames_`
  std::size_t first_ = 0;  ///< the frames before it were taken
  std::size_t end_ = 0;
};

}  // namespace takt::sim
