#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eds_parser/table/time.hpp"
#include "master/sim/bus_node.hpp"
#include "master/sim/random.hpp"
#include "master/sim/wire_frame.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// What happened on the bus since the start.
struct BusCounters {
  std::uint64_t frames = 0;  ///< sent whole
  std::uint64_t bits = 0;    ///< the wire was busy for, error frames and IFS included
  std::uint64_t error_frames = 0;
  std::uint64_t expired = 0;     ///< dropped by their senders: too late
  std::uint64_t overflowed = 0;  ///< found the queue of their sender full
  std::uint64_t lost = 0;        ///< by a fault
  std::uint64_t duplicated = 0;  ///< by a fault
};

/// One CAN segment in virtual time: exact frame lengths, arbitration, error frames with
/// retransmission, error counters, bus-off. The owner calls step() whenever next_event() has come.
class VirtualBus {
 public:
  VirtualBus(std::uint32_t bitrate, Random random);

  /// Only during construction of the world.
  BusNodeIndex attach(BusNodeOptions options);
  BusNode& node(BusNodeIndex index) noexcept { return nodes_[index]; }
  const BusNode& node(BusNodeIndex index) const noexcept { return nodes_[index]; }
  std::size_t size() const noexcept { return nodes_.size(); }

  /// Offers a frame from `ready` on; dropped where it is not on the wire before `expires`. False:
  /// the queue is full or the node is off the bus.
  bool queue(BusNodeIndex from, const Frame& frame, Time ready, Time expires = never) noexcept;
  void drop_queue(BusNodeIndex from) noexcept;
  void set_powered(BusNodeIndex index, bool on, Time now) noexcept;
  void set_bus_off(BusNodeIndex index, Time now) noexcept;
  /// Acknowledges everything: a bus without other devices works all the same.
  void set_analyser(bool present) noexcept { analyser_ = present; }

  Time next_event() const noexcept { return next_; }
  /// Does what is due at next_event(). True: a frame has left the wire; it is in `wire`.
  bool step(Time now, WireFrame& wire) noexcept;

  Time bit_time(std::uint32_t bits) const noexcept {
    return Time{static_cast<Time::rep>(bits * std::uint64_t{1'000'000'000} / bitrate_)};
  }
  std::uint32_t bitrate() const noexcept { return bitrate_; }
  /// From the next frame on.
  void set_bitrate(std::uint32_t bitrate) noexcept;
  const BusCounters& counters() const noexcept { return counters_; }

  /// A node has gone bus-off or come back since the last call; nobody: none.
  BusNodeIndex take_change() noexcept;
  static constexpr BusNodeIndex nobody = 0xFFFF;

 private:
  void schedule() noexcept;
  void arbitrate(Time now) noexcept;
  void begin(Time now) noexcept;
  std::uint32_t bits_until_error(std::uint32_t frame_length) noexcept;
  void finish(Time now, WireFrame& wire) noexcept;
  void finish_good(WireFrame& wire) noexcept;
  void finish_bad(Time now) noexcept;
  void punish(BusNodeIndex index, Time now) noexcept;
  void go_bus_off(BusNodeIndex index, Time now) noexcept;
  void repeat(BusNodeIndex index, const QueuedFrame& frame) noexcept;
  void recover(Time now) noexcept;
  void mark(BusNodeIndex index) noexcept;
  bool acknowledged(BusNodeIndex sender) const noexcept;

  std::uint32_t bitrate_ = 1'000'000;
  Random random_;
  std::vector<BusNode> nodes_;
  std::vector<std::uint64_t> waiting_;  ///< bit set: nodes with queued frames
  std::vector<BusNodeIndex> changes_;
  BusCounters counters_;
  bool analyser_ = false;
  std::size_t on_bus_ = 0;  ///< nodes that are powered and not bus-off
  std::size_t recovering_ = 0;
  Time next_ = never;
  Time idle_from_{};
  bool busy_ = false;
  QueuedFrame current_;
  BusNodeIndex sender_ = nobody;
  BusNodeIndex rival_ = nobody;  ///< sends the same identifier at the same time
  WireFrame wire_;
};

}  // namespace takt::sim
