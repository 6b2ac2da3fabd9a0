#include "master/sim/bus/bus_node.hpp"

#include <bit>

#include "master/sim/bus/frame_bits.hpp"

namespace takt::sim {

namespace {

/// Compares frames as words, which is less work than comparing their data byte by byte.
bool same(const Frame& a, const Frame& b) noexcept {
  using Word = std::uint64_t;
  return std::bit_cast<Word>(a.data) == std::bit_cast<Word>(b.data) && a.id == b.id &&
         a.length == b.length && a.rtr == b.rtr;
}

}  // namespace

BusNode::BusNode(BusNodeOptions node_options)
    : options{node_options}, queue_{options.capacity + 1} {}

/// Queues a frame with its length in bits. The length is counted here and not at the start of the
/// frame, where the processor would wait for the result to compute the end of the frame. A queue
/// that becomes empty begins again at its first place, so a frame that is sent in each cycle finds
/// its predecessor there. If both are equal, the bits are not counted again.
bool BusNode::push(const Frame& frame, Time ready, Time expires) noexcept {
  if (queue_.size() >= options.capacity) return false;
  first_expiry_ = std::min(first_expiry_, expires);
  QueuedFrame& queued = queue_.push_back();
  if (queued.bits == 0 || !same(queued.frame, frame)) {
    queued.frame = frame;
    queued.rank = arbitration_rank(frame);
    queued.bits = frame_bits(frame).total;
  }
  queued.repetition = false;
  queued.ready = ready;
  queued.expires = expires;
  return true;
}

void BusNode::put_back(const QueuedFrame& frame) noexcept {
  if (queue_.full()) return;
  first_expiry_ = std::min(first_expiry_, frame.expires);
  queue_.push_front(frame);
}

std::size_t BusNode::erase_expired(Time now) noexcept {
  const std::size_t dropped =
      queue_.erase_if([now](const QueuedFrame& frame) { return frame.expires < now; });
  first_expiry_ = never;
  for (const QueuedFrame& frame : queue_) first_expiry_ = std::min(first_expiry_, frame.expires);
  return dropped;
}

std::size_t BusNode::lowest_ready(Time now) const noexcept {
  std::size_t best = queue_.size();
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    if (queue_[i].ready > now) continue;
    if (best == queue_.size() || queue_[i].rank < queue_[best].rank) best = i;
  }
  return best;
}

std::uint32_t BusNode::lowest_rank() const noexcept {
  return std::ranges::min_element(queue_, {}, &QueuedFrame::rank)->rank;
}

Time BusNode::first_ready() const noexcept {
  return std::ranges::min_element(queue_, {}, &QueuedFrame::ready)->ready;
}

}  // namespace takt::sim
