#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/sim/bus/wire_frame.hpp"

namespace takt::sim {

/// The frame that a node offers to the bus.
struct Offer {
  Time from = never;       ///< the node offers nothing earlier
  std::uint32_t rank = 0;  ///< no frame of the node has a lower rank
  BusNodeIndex node = 0;
  /// Several frames compete, and the time decides which of them the node offers.
  bool by_priority = false;
};

/// The offers of all nodes that have queued frames, by ascending rank. The first offer usually wins
/// the arbitration and leaves; new offers usually have a higher rank than those that wait. In both
/// cases, no other offer moves. Nothing allocates memory after reserve().
class OfferList {
 public:
  /// Makes room for the offers of this number of nodes.
  void reserve(std::size_t nodes) { offers_.resize(nodes); }

  std::span<const Offer> all() const noexcept { return {offers_.data() + first_, end_ - first_}; }
  bool empty() const noexcept { return first_ == end_; }
  /// Requires that the list is not empty.
  const Offer& first() const noexcept { return offers_[first_]; }
  /// Requires that the list has no offer of this node.
  void add(const Offer& offer) noexcept {
    if (end_ == offers_.size()) close_gap();
    std::size_t place = end_++;
    for (; place != first_ && offer.rank < offers_[place - 1].rank; --place) {
      offers_[place] = offers_[place - 1];
    }
    offers_[place] = offer;
  }
  /// Removes the offer of this node, if there is one.
  void remove(BusNodeIndex node) noexcept {
    std::size_t place = first_;
    while (place != end_ && offers_[place].node != node) ++place;
    if (place == end_) return;
    if (place != first_) {
      std::copy(at(place + 1), at(end_), at(place));
      --end_;
    } else if (++first_ == end_) {
      first_ = end_ = 0;
    }
  }

 private:
  std::vector<Offer>::iterator at(std::size_t place) noexcept {
    return offers_.begin() + static_cast<std::ptrdiff_t>(place);
  }
  void close_gap() noexcept {
    std::copy(at(first_), at(end_), at(0));
    end_ -= first_;
    first_ = 0;
  }

  std::vector<Offer> offers_;
  std::size_t first_ = 0;  ///< the offers before it have left
  std::size_t end_ = 0;
};

}  // namespace takt::sim
