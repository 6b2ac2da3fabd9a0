#include "master/motion/beat/stream_player.hpp"

namespace takt::motion {

bool StreamPlayer::add(const StreamPoint& point) noexcept {
  if (size_ == capacity || !is_finite(point) || !(point.time > last_.time)) tail_ = Tail::cut;
  if (tail_ == Tail::cut) return false;
  const StreamPoint whole = reached(last_, point);
  points_[(first_ + size_) % capacity] = whole;
  if (size_ == 0) segment_ = {passed_, whole};
  last_ = whole;
  ++size_;
  return true;
}

State StreamPlayer::at(double time) noexcept {
  while (size_ != 0 && time >= points_[first_].time) {
    passed_ = points_[first_];
    first_ = (first_ + 1) % capacity;
    if (--size_ != 0) segment_ = {passed_, points_[first_]};
  }
  return size_ == 0 ? passed_.state : segment_.at(time);
}

}  // namespace takt::motion
