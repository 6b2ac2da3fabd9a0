#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "eds_parser/table/time.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// Which of its queued frames a controller offers to the bus.
enum class QueueOrder : std::uint8_t {
  fifo,      ///< the oldest, as SocketCAN does
  priority,  ///< the one with the lowest identifier, as a controller with many mailboxes does
};

struct BusNodeOptions {
  QueueOrder order = QueueOrder::priority;
  std::size_t capacity = 64;  ///< frames
  Time restart = Time{};      ///< after bus-off, besides 128 x 11 bits; `never`: stays off
  /// Its frames have been on a wire elsewhere: they have won, so that nobody's can collide with
  /// them.
  bool relays = false;
};

/// Faults of the frames that one node sends.
struct SenderFaults {
  double loss = 0.0;
  double duplicate = 0.0;
  double error = 0.0;
  Time delay{};
};

/// A frame that waits for the wire.
struct QueuedFrame {
  Frame frame{};
  std::uint32_t rank = 0;   ///< arbitration: the lowest wins
  bool repetition = false;  ///< made by a fault
  Time ready{};
  Time expires = never;
};

/// Bits in the order of arbitration: identifier, RTR or SRR, IDE, rest of the identifier, RTR.
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

  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  bool push(const QueuedFrame& frame) noexcept;
  QueuedFrame take(std::size_t position) noexcept;
  /// Before all others: a frame that was destroyed on the wire.
  void put_back(const QueuedFrame& frame) noexcept;
  void clear() noexcept { queue_.clear(); }
  bool empty() const noexcept { return queue_.empty(); }
  /// How many there were.
  std::size_t drop_expired(Time now) noexcept;
  /// Position of the frame that is offered to the bus at `now`, else `none`.
  std::size_t offered(Time now) const noexcept;
  const QueuedFrame& at(std::size_t position) const noexcept { return queue_[position]; }
  std::size_t queued() const noexcept { return queue_.size(); }
  /// When the earliest of the queued frames may be offered.
  Time earliest() const noexcept;

  bool on_bus() const noexcept { return powered && !bus_off; }
  bool error_passive(std::uint64_t frames) const noexcept {
    return transmit_errors > 127 || receive_errors(frames) > 127;
  }
  /// Counts down with each good frame on the bus (`frames` so far).
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
  std::uint32_t error_frames = 0;  ///< seen while on the bus
  std::uint32_t times_bus_off = 0;
  bool powered = true;
  bool bus_off = false;
  Time recovers = never;
  Time suspended_until{};  ///< error-passive nodes wait after a frame of their own

 private:
  std::vector<QueuedFrame> queue_;  ///< never beyond its first capacity
  bool may_expire_ = false;
  std::uint32_t receive_errors_ = 0;
  std::uint64_t receive_errors_at_ = 0;
};

}  // namespace takt::sim
