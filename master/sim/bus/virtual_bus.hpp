#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eds_parser/values/time.hpp"
#include "master/sim/bus/bus_node.hpp"
#include "master/sim/bus/offer_list.hpp"
#include "master/sim/bus/wire_frame.hpp"
#include "master/sim/random.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// Counters of the bus since the start.
struct BusCounters {
  std::uint64_t frames = 0;  ///< frames sent completely
  std::uint64_t bits = 0;    ///< bit times of a busy wire, with error frames and IFS
  std::uint64_t error_frames = 0;
  std::uint64_t expired = 0;     ///< frames that their senders dropped because they were too late
  std::uint64_t overflowed = 0;  ///< frames dropped because the queue of their sender was full
  std::uint64_t lost = 0;        ///< frames lost by a fault
  std::uint64_t duplicated = 0;  ///< frames duplicated by a fault
};

/// One CAN segment in virtual time: exact frame lengths, arbitration, error frames with
/// retransmission, error counters, bus-off. The owner calls step() whenever next_event() has come.
class VirtualBus {
 public:
  VirtualBus(std::uint32_t bitrate, Random random);

  /// Adds a node. May be called only during construction of the world.
  BusNodeIndex attach(BusNodeOptions options);
  BusNode& node(BusNodeIndex index) noexcept { return nodes_[index]; }
  const BusNode& node(BusNodeIndex index) const noexcept { return nodes_[index]; }
  std::size_t size() const noexcept { return nodes_.size(); }

  /// Offers a frame from `ready` on. The frame is dropped if it is not on the wire before
  /// `expires`. Returns false if the queue is full or the node is off the bus.
  bool queue(BusNodeIndex from, const Frame& frame, Time ready, Time expires = never) noexcept;
  void set_powered(BusNodeIndex index, bool on, Time now) noexcept;
  void set_bus_off(BusNodeIndex index, Time now) noexcept;
  /// Adds or removes an analyser that acknowledges every frame, so that a bus without other devices
  /// works too.
  void set_analyser(bool present) noexcept { analyser_ = present; }

  Time next_event() const noexcept { return next_; }
  /// Does the work that is due at next_event(). Returns true if a frame has left the wire.
  bool step(Time now) noexcept;
  /// Returns the frame that has left the wire; valid until the next step.
  const WireFrame& wire() const noexcept { return wire_; }

  Time bit_time(std::uint32_t bits) const noexcept {
    const std::uint64_t rest = bit_rest_ == 0 ? 0 : bits * bit_rest_ / bitrate_;
    return Time{static_cast<Time::rep>(bits * bit_ns_ + rest)};
  }
  std::uint32_t bitrate() const noexcept { return bitrate_; }
  /// Sets the bit rate, which applies from the next frame on.
  void set_bitrate(std::uint32_t bitrate) noexcept;
  const BusCounters& counters() const noexcept { return counters_; }

  /// Returns one node that has gone bus-off or has come back since the last call, or `nobody`.
  BusNodeIndex take_change() noexcept {
    if (changes_.empty()) return nobody;
    const BusNodeIndex index = changes_.back();
    changes_.pop_back();
    return index;
  }
  static constexpr BusNodeIndex nobody = 0xFFFF;

 private:
  void schedule() noexcept {
    if (recovering_ != 0) [[unlikely]] {
      return find_next_event();
    }
    if (busy_) {
      next_ = wire_.end;
    } else if (!offers_.empty() && offers_.first().from <= idle_from_) {
      next_ = idle_from_;
    } else {
      find_next_event();
    }
  }
  [[gnu::noinline]] void find_next_event() noexcept;
  void arbitrate(Time now) noexcept;
  void begin(Time now) noexcept;
  [[gnu::cold, gnu::noinline]] void meet_rival(Time now) noexcept;
  [[gnu::cold, gnu::noinline]] std::uint32_t bits_until_error(std::uint32_t frame_length) noexcept;
  void finish(Time now) noexcept;
  /// Begins the pause of an error-passive node after its own frame.
  void pause(BusNodeIndex index) noexcept {
    if (nodes_[index].error_passive(counters_.frames)) [[unlikely]]
      suspend(index);
  }
  [[gnu::cold, gnu::noinline]] void suspend(BusNodeIndex index) noexcept;
  void finish_good() noexcept;
  [[gnu::cold, gnu::noinline]] void finish_bad(Time now) noexcept;
  void punish(BusNodeIndex index, Time now) noexcept;
  void go_bus_off(BusNodeIndex index, Time now) noexcept;
  [[gnu::cold, gnu::noinline]] void duplicate() noexcept;
  void repeat(BusNodeIndex index, const QueuedFrame& frame) noexcept;
  [[gnu::cold, gnu::noinline]] void recover(Time now) noexcept;
  QueuedFrame take(BusNodeIndex index, Time now) noexcept;
  [[gnu::noinline]] void drop_expired(Time now) noexcept;
  void renew_offer(BusNodeIndex index) noexcept;
  Offer offer_of(BusNodeIndex index) const noexcept;
  std::uint32_t rank_at(const Offer& offer, Time now) const noexcept;
  [[gnu::cold, gnu::noinline]] void find_rival(std::uint32_t rank, Time now) noexcept;
  bool relays(BusNodeIndex index) const noexcept { return nodes_[index].options.relays; }
  /// Returns true if the frame is acknowledged: by the analyser, or by another node. The sender is
  /// one of the nodes on the bus.
  bool acknowledged() const noexcept { return analyser_ || on_bus_ > 1; }

  std::uint32_t bitrate_ = 1'000'000;
  std::uint64_t bit_ns_ = 1'000;  ///< whole nanoseconds of a bit
  std::uint64_t bit_rest_ = 0;    ///< remainder of that division; 0 at the usual bit rates
  Random random_;
  std::vector<BusNode> nodes_;
  OfferList offers_;           ///< each change of the queue of a node renews its offer
  Time first_expiry_ = never;  ///< no queued frame expires earlier
  std::vector<BusNodeIndex> changes_;
  BusCounters counters_;
  bool analyser_ = false;
  std::size_t on_bus_ = 0;  ///< number of nodes that are powered and not bus-off
  std::size_t recovering_ = 0;
  Time next_ = never;
  Time idle_from_{};
  bool busy_ = false;
  QueuedFrame current_;
  BusNodeIndex sender_ = nobody;
  BusNodeIndex rival_ = nobody;  ///< node that sends the same identifier at the same time
  WireFrame wire_;
};

}  // namespace takt::sim
