#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eds_parser/table/time.hpp"
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

/// Frames in the order of their arrival. To take the first one moves no others. Nothing allocates
/// memory after construction.
class FrameQueue {
 public:
  explicit FrameQueue(std::size_t capacity) { frames_.reserve(capacity); }

  bool empty() const noexcept { return first_ == frames_.size(); }
  std::size_t size() const noexcept { return frames_.size() - first_; }
  bool full() const noexcept { return size() == frames_.capacity(); }
  const QueuedFrame& operator[](std::size_t position) const noexcept {
    return frames_[first_ + position];
  }
  auto begin() const noexcept { return frames_.begin() + static_cast<std::ptrdiff_t>(first_); }
  auto end() const noexcept { return frames_.end(); }

  /// Appends a frame and returns it, to be filled in its place. Requires that the queue is not
  /// full.
  QueuedFrame& push_back() noexcept {
    if (frames_.size() == frames_.capacity()) close_gap();
    return frames_.emplace_back();
  }
  /// Requires that the queue is not full.
  void push_front(const QueuedFrame& frame) noexcept {
    if (first_ == 0) {
      frames_.insert(frames_.begin(), frame);
    } else {
      frames_[--first_] = frame;
    }
  }
  QueuedFrame take(std::size_t position) noexcept {
    const QueuedFrame frame = (*this)[position];
    if (position != 0) {
      frames_.erase(begin() + static_cast<std::ptrdiff_t>(position));
    } else if (++first_ == frames_.size()) {
      clear();
    }
    return frame;
  }
  template <class Condition>
  std::size_t erase_if(Condition condition) noexcept {
    close_gap();
    return std::erase_if(frames_, condition);
  }
  void clear() noexcept {
    frames_.clear();
    first_ = 0;
  }

 private:
  void close_gap() noexcept {
    frames_.erase(frames_.begin(), begin());
    first_ = 0;
  }

  std::vector<QueuedFrame> frames_;
  std::size_t first_ = 0;  ///< the frames before it were taken
};

}  // namespace takt::sim
