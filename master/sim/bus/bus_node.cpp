#include "master/sim/bus/bus_node.hpp"

#include <algorithm>

namespace takt::sim {

BusNode::BusNode(BusNodeOptions node_options) : options{node_options} {
  queue_.reserve(options.capacity + 1);
}

bool BusNode::push(const QueuedFrame& frame) noexcept {
  if (queue_.size() >= options.capacity) return false;
  if (frame.expires != never) may_expire_ = true;
  queue_.push_back(frame);
  return true;
}

QueuedFrame BusNode::take(std::size_t position) noexcept {
  const QueuedFrame frame = queue_[position];
  queue_.erase(queue_.begin() + static_cast<std::ptrdiff_t>(position));
  return frame;
}

void BusNode::put_back(const QueuedFrame& frame) noexcept {
  if (queue_.size() < queue_.capacity()) queue_.insert(queue_.begin(), frame);
}

std::size_t BusNode::drop_expired(Time now) noexcept {
  if (!may_expire_) return 0;
  return std::erase_if(queue_, [now](const QueuedFrame& frame) { return frame.expires < now; });
}

std::size_t BusNode::offered(Time now) const noexcept {
  if (options.order == QueueOrder::fifo) return !empty() && queue_[0].ready <= now ? 0 : none;
  std::size_t best = none;
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    if (queue_[i].ready > now) continue;
    if (best == none || queue_[i].rank < queue_[best].rank) best = i;
  }
  return best;
}

Time BusNode::earliest() const noexcept {
  if (empty()) return never;
  Time earliest = queue_[0].ready;
  if (options.order == QueueOrder::priority) {
    for (const QueuedFrame& frame : queue_) earliest = std::min(earliest, frame.ready);
  }
  return std::max(earliest, suspended_until);
}

}  // namespace takt::sim
