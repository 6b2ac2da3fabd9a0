#include "master/sim/bus/virtual_bus.hpp"

#include <algorithm>
#include <bit>

#include "master/sim/bus/frame_bits.hpp"

namespace takt::sim {
namespace {

constexpr std::uint32_t error_flag_bits = 6;  // up to 12 if the error flags of other nodes follow
constexpr std::uint32_t error_delimiter_bits = 8;
constexpr std::uint32_t suspend_bits = 8;
constexpr std::uint32_t recovery_bits = 128 * 11;

}  // namespace

VirtualBus::VirtualBus(std::uint32_t bitrate, Random random) : random_{random} {
  set_bitrate(bitrate);
}

void VirtualBus::set_bitrate(std::uint32_t bitrate) noexcept {
  constexpr std::uint64_t second_ns = 1'000'000'000;
  bitrate_ = std::clamp(bitrate, 1'000u, 10'000'000u);
  bit_ns_ = second_ns / bitrate_;
  bit_rest_ = second_ns % bitrate_;
}

BusNodeIndex VirtualBus::attach(BusNodeOptions options) {
  const auto index = static_cast<BusNodeIndex>(nodes_.size());
  nodes_.emplace_back(options);
  offers_.reserve(nodes_.size());
  changes_.reserve(nodes_.size() + 8);
  ++on_bus_;
  return index;
}

bool VirtualBus::queue(BusNodeIndex from, const Frame& frame, Time ready, Time expires) noexcept {
  BusNode& node = nodes_[from];
  if (!node.on_bus()) return false;
  if (node.faults.delay > Time{}) {
    ready += Time{static_cast<Time::rep>(random_.next() %
                                         static_cast<std::uint64_t>(node.faults.delay.count()))};
  }
  if (!node.push(frame, ready, expires)) {
    ++counters_.overflowed;
    return false;
  }
  first_expiry_ = std::min(first_expiry_, expires);
  // In a fifo queue, a frame behind another frame does not change what the node offers.
  if (node.queued() == 1) {
    offers_.add(offer_of(from));
  } else if (node.options.order == QueueOrder::priority) {
    renew_offer(from);
  }
  if (!busy_) next_ = std::min(next_, std::max({idle_from_, ready, node.suspended_until}));
  return true;
}

void VirtualBus::renew_offer(BusNodeIndex index) noexcept {
  offers_.remove(index);
  if (!nodes_[index].empty()) offers_.add(offer_of(index));
}

Offer VirtualBus::offer_of(BusNodeIndex index) const noexcept {
  const BusNode& node = nodes_[index];
  Offer offer{.from = node.at(0).ready,
              .rank = node.at(0).rank,
              .node = index,
              .by_priority = node.offers_any()};
  if (offer.by_priority) [[unlikely]] {
    offer.from = node.first_ready();
    offer.rank = node.lowest_rank();
  }
  offer.from = std::max(offer.from, node.suspended_until);
  return offer;
}

void VirtualBus::set_powered(BusNodeIndex index, bool on, Time now) noexcept {
  BusNode& node = nodes_[index];
  if (node.powered == on) return;
  if (node.on_bus()) --on_bus_;
  if (node.bus_off && node.recovers != never) --recovering_;
  node.powered = on;
  node.bus_off = false;
  node.recovers = never;
  node.clear();
  renew_offer(index);
  node.reset_errors();
  if (on) ++on_bus_;
  if (busy_ && sender_ == index && !on) wire_.result = WireResult::destroyed;
  if (!busy_) idle_from_ = std::max(idle_from_, now);
}

void VirtualBus::set_bus_off(BusNodeIndex index, Time now) noexcept {
  if (nodes_[index].on_bus()) go_bus_off(index, now);
  if (!busy_) schedule();
}

bool VirtualBus::step(Time now) noexcept {
  if (recovering_ != 0) recover(now);
  if (busy_) {
    if (wire_.end > now) {
      schedule();
      return false;
    }
    finish(now);
    schedule();
    return true;
  }
  arbitrate(now);
  return false;
}

/// Finds the time of the next event. No frame can begin before the bus is idle, so the search stops
/// at the first node that offers a frame by that time.
void VirtualBus::find_next_event() noexcept {
  next_ = never;
  if (recovering_ != 0) {
    for (const BusNode& node : nodes_) next_ = std::min(next_, node.recovers);
  }
  if (busy_) {
    next_ = std::min(next_, wire_.end);
    return;
  }
  for (const Offer& offer : offers_.all()) {
    next_ = std::min(next_, std::max(idle_from_, offer.from));
    if (next_ <= idle_from_) return;
  }
}

/// Selects the sender: of all controllers that offer a frame, the lowest rank wins. ISO 11898-1,
/// 10.4.
void VirtualBus::arbitrate(Time now) noexcept {
  sender_ = rival_ = nobody;
  if (first_expiry_ < now) drop_expired(now);
  std::uint32_t best = 0;
  bool equal = false;  // several nodes offer the lowest rank
  for (const Offer& offer : offers_.all()) {
    if (sender_ != nobody && offer.rank > best) break;
    if (offer.from > now) continue;
    const std::uint32_t rank = rank_at(offer, now);
    if (sender_ == nobody || rank < best) {
      best = rank;
      sender_ = offer.node;
      equal = false;
    } else if (rank == best) {
      sender_ = std::min(sender_, offer.node);
      equal = true;
    }
  }
  if (equal) find_rival(best, now);
  if (sender_ != nobody) begin(now);
  schedule();
}

/// Finds a node that sends a frame of the rank of the sender at the same time.
void VirtualBus::find_rival(std::uint32_t rank, Time now) noexcept {
  if (relays(sender_)) return;
  for (const Offer& offer : offers_.all()) {
    const BusNodeIndex index = offer.node;
    if (index == sender_ || relays(index) || offer.from > now) continue;
    if (rank_at(offer, now) != rank) continue;
    rival_ = rival_ == nobody ? index : std::max(rival_, index);
  }
}

std::uint32_t VirtualBus::rank_at(const Offer& offer, Time now) const noexcept {
  return offer.by_priority ? nodes_[offer.node].offered(now).rank : offer.rank;
}

void VirtualBus::drop_expired(Time now) noexcept {
  first_expiry_ = never;
  for (BusNodeIndex i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].empty()) continue;
    counters_.expired += nodes_[i].drop_expired(now);
    first_expiry_ = std::min(first_expiry_, nodes_[i].first_expiry());
    renew_offer(i);
  }
}

/// Takes the frame that the node offers.
QueuedFrame VirtualBus::take(BusNodeIndex index, Time now) noexcept {
  const QueuedFrame frame = nodes_[index].take(now);
  renew_offer(index);
  return frame;
}

void VirtualBus::begin(Time now) noexcept {
  current_ = take(sender_, now);
  wire_.frame = current_.frame;
  wire_.start = now;
  wire_.sender = sender_;
  wire_.result = WireResult::sent;
  wire_.bits = current_.bits;
  if (rival_ != nobody) [[unlikely]]
    meet_rival(now);
  if (random_.chance(nodes_[sender_].faults.error)) wire_.result = WireResult::destroyed;
  if (wire_.result == WireResult::sent && !acknowledged()) {
    wire_.result = WireResult::unacknowledged;
  }
  if (wire_.result != WireResult::sent) [[unlikely]] {
    wire_.bits = static_cast<std::uint16_t>(bits_until_error(current_.bits));
  }
  wire_.end = now + bit_time(wire_.bits);
  busy_ = true;
}

/// Handles two nodes that send the same identifier. Equal frames have no effect on each other;
/// different frames destroy each other.
void VirtualBus::meet_rival(Time now) noexcept {
  if (nodes_[rival_].offered(now).frame == current_.frame) {
    take(rival_, now);
  } else {
    wire_.result = WireResult::destroyed;
  }
}

/// Returns the number of bits of the frame until it is destroyed, plus those of the error frame.
std::uint32_t VirtualBus::bits_until_error(std::uint32_t frame_length) noexcept {
  const std::uint32_t error_frame = error_flag_bits + error_delimiter_bits;
  if (wire_.result == WireResult::unacknowledged) return frame_length - 8 + error_frame;
  const std::uint32_t first = rival_ != nobody ? 19 : 1;  // first bit after the identifier
  const std::uint32_t echoes = random_.below(error_flag_bits + 1);
  return first + random_.below(frame_length - first) + echoes + error_frame;
}

void VirtualBus::finish(Time now) noexcept {
  busy_ = false;
  counters_.bits += wire_.bits + interframe_bits;
  idle_from_ = now + bit_time(interframe_bits);
  if (wire_.result == WireResult::sent) {
    finish_good();
  } else {
    finish_bad(now);
  }
  pause(sender_);
  if (rival_ != nobody) pause(rival_);
}

void VirtualBus::suspend(BusNodeIndex index) noexcept {
  nodes_[index].suspended_until = idle_from_ + bit_time(suspend_bits);
  renew_offer(index);
}

void VirtualBus::finish_good() noexcept {
  ++counters_.frames;
  BusNode& sender = nodes_[sender_];
  if (sender.transmit_errors != 0) --sender.transmit_errors;
  if (!current_.repetition && random_.chance(sender.faults.duplicate)) duplicate();
  if (random_.chance(sender.faults.loss)) {
    ++counters_.lost;
    wire_.result = WireResult::lost;
  }
}

void VirtualBus::duplicate() noexcept {
  ++counters_.duplicated;
  QueuedFrame again = current_;
  again.repetition = true;
  repeat(sender_, again);
}

void VirtualBus::finish_bad(Time now) noexcept {
  ++counters_.error_frames;
  for (BusNodeIndex i = 0; i < nodes_.size(); ++i) {
    if (!nodes_[i].on_bus()) continue;
    ++nodes_[i].error_frames;
    if (i != sender_ && i != rival_) nodes_[i].add_receive_error(counters_.frames);
  }
  if (nodes_[sender_].on_bus()) repeat(sender_, current_);
  punish(sender_, now);
  if (rival_ != nobody) punish(rival_, now);
}

void VirtualBus::repeat(BusNodeIndex index, const QueuedFrame& frame) noexcept {
  nodes_[index].put_back(frame);
  first_expiry_ = std::min(first_expiry_, frame.expires);
  renew_offer(index);
}

void VirtualBus::punish(BusNodeIndex index, Time now) noexcept {
  BusNode& node = nodes_[index];
  if (!node.on_bus()) return;
  // The counter of an error-passive node does not grow without an acknowledge, so a lone node never
  // goes bus-off.
  const bool alone = wire_.result == WireResult::unacknowledged;
  if (alone && node.transmit_errors > 127) return;
  node.transmit_errors += 8;
  if (node.transmit_errors > 255) go_bus_off(index, now);
}

void VirtualBus::go_bus_off(BusNodeIndex index, Time now) noexcept {
  BusNode& node = nodes_[index];
  node.bus_off = true;
  ++node.times_bus_off;
  node.clear();
  renew_offer(index);
  --on_bus_;
  if (changes_.size() < changes_.capacity()) changes_.push_back(index);
  if (node.options.restart == never) return;
  node.recovers = now + node.options.restart + bit_time(recovery_bits);
  ++recovering_;
}

void VirtualBus::recover(Time now) noexcept {
  for (BusNodeIndex i = 0; i < nodes_.size(); ++i) {
    BusNode& node = nodes_[i];
    if (node.recovers > now) continue;
    node.recovers = never;
    node.bus_off = false;
    node.reset_errors();
    ++on_bus_;
    --recovering_;
    if (changes_.size() < changes_.capacity()) changes_.push_back(i);
  }
}

}  // namespace takt::sim
