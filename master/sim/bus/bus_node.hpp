#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "eds_parser/values/time.hpp"
#include "master/sim/bus/frame_queue.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// The frame of its queue that a controller offers to the bus next.
enum class QueueOrder : std::uint8_t {
  fifo,      ///< the oldest frame, as in a SocketCAN queue
  priority,  ///< the frame with the lowest identifier, as in a controller with many mailboxes
};

struct BusNodeOptions {
  QueueOrder order = QueueOrder::priority;
  std::size_t capacity = 64;  ///< frames
  Time restart = Time{};  ///< delay after bus-off in addition to 128 x 11 bits; with `never` the
                          ///< node stays off
  /// The frames of this node have already won arbitration on another wire, so no other frame can
  /// collide with them.
  bool relays = false;
};

/// Faults of the frames that one node sends.
struct SenderFaults {
  double loss = 0.0;
  double duplicate = 0.0;
  double error = 0.0;
  Time delay{};
};

/// Returns the bits in the order of arbitration: identifier, RTR or SRR, IDE, rest of the
/// identifier, RTR.
constexpr std::uint32_t arbitration_rank(const Frame& frame) noexcept {
  const std::uint32_t id = frame.id.id();
  const std::uint32_t rtr = frame.rtr ? 1 : 0;
  if (!frame.id.is_extended()) return id << 21 | rtr << 20;
  return (id >> 18) << 21 | 3u << 19 | (id & 0x3'FFFF) << 1 | rtr;
}

/// One CAN controller: its queue and its error counters. ISO 11898-1.
class BusNode {
 public:
  explicit BusNode(BusNodeOptions options);

  /// Returns false if the queue is full.
  bool push(const Frame& frame, Time ready, Time expires) noexcept;
  /// Takes the frame that the node offers to the bus at `now`. Requires that it offers one.
  QueuedFrame take(Time now) noexcept { return queue_.take(offers_any() ? lowest_ready(now) : 0); }
  /// Puts a frame that was destroyed on the wire back at the front of the queue.
  void put_back(const QueuedFrame& frame) noexcept;
  void clear() noexcept { queue_.clear(); }
  bool empty() const noexcept { return queue_.empty(); }
  /// Drops the frames that have expired and returns their number.
  std::size_t drop_expired(Time now) noexcept {
    return first_expiry_ < now ? erase_expired(now) : 0;
  }
  /// Returns a time before which no queued frame expires.
  Time first_expiry() const noexcept { return first_expiry_; }
  /// Returns true if several frames compete by priority, so that the order of their arrival does
  /// not decide.
  bool offers_any() const noexcept {
    return options.order == QueueOrder::priority && queue_.size() > 1;
  }
  /// Returns the frame that the node offers to the bus at `now`. Requires that it offers one.
  const QueuedFrame& offered(Time now) const noexcept {
    return queue_[offers_any() ? lowest_ready(now) : 0];
  }
  const QueuedFrame& at(std::size_t position) const noexcept { return queue_[position]; }
  std::size_t queued() const noexcept { return queue_.size(); }
  // Returns the earliest time at which a queued frame is ready. Requires that there is one. This
  // function and the next one are not inlined, because few nodes have several frames at once.
  [[gnu::noinline]] Time first_ready() const noexcept;
  /// Returns the lowest rank of the queued frames. Requires that there is one.
  [[gnu::noinline]] std::uint32_t lowest_rank() const noexcept;

  bool on_bus() const noexcept { return powered && !bus_off; }
  bool error_passive(std::uint64_t frames) const noexcept {
    return transmit_errors > 127 || receive_errors(frames) > 127;
  }
  /// Returns the receive error counter. It counts down with each good frame on the bus; `frames` is
  /// the number of good frames since the start.
  std::uint32_t receive_errors(std::uint64_t frames) const noexcept {
    const std::uint64_t good = frames - receive_errors_at_;
    return good >= receive_errors_ ? 0 : receive_errors_ - static_cast<std::uint32_t>(good);
  }
  void add_receive_error(std::uint64_t frames) noexcept {
    receive_errors_ = receive_errors(frames) + 1;
    receive_errors_at_ = frames;
    if (receive_errors_ > 255) receive_errors_ = 255;
  }
  void reset_errors() noexcept { transmit_errors = receive_errors_ = 0; }

  BusNodeOptions options;
  SenderFaults faults;
  std::uint32_t transmit_errors = 0;
  std::uint32_t error_frames = 0;  ///< error frames seen while on the bus
  std::uint32_t times_bus_off = 0;
  bool powered = true;
  bool bus_off = false;
  Time recovers = never;
  Time suspended_until{};  ///< end of the pause of an error-passive node after its own frame

 private:
  [[gnu::noinline]] std::size_t lowest_ready(Time now) const noexcept;
  std::size_t erase_expired(Time now) noexcept;

  FrameQueue queue_;           ///< has room for `capacity` frames and one that was put back
  Time first_expiry_ = never;  ///< no queued frame expires before this time
  std::uint32_t receive_errors_ = 0;
  std::uint64_t receive_errors_at_ = 0;
};

}  // namespace takt::sim
