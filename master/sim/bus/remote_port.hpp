#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/rt/port.hpp"
#include "master/sim/bus/virtual_bus.hpp"
#include "master/sim/random.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

struct RemotePortOptions {
  std::size_t tx_queue = 128;   ///< frames, like SocketCAN's txqueuelen; a full queue gives ENOBUFS
  std::size_t rx_queue = 1024;  ///< frames; a full queue counts receive_overruns
  CobId sync = CobId::base(0x080);  ///< an own frame with this identifier counts as SYNC echo
  Time restart = std::chrono::milliseconds{100};  ///< delay after bus-off; `never` means no restart
  bool relays = false;                            ///< as in BusNodeOptions
  Time epoch = std::chrono::days{20454};  ///< time of day at the world's time 0: 2026-01-01 UTC
  Time wake_jitter{};  ///< sleep_until and wait_frame return up to this time late
  Time spin_jitter{};  ///< sleep_precisely_until returns up to this time late
};

/// The CAN controller of a node outside the world, such as the master. Its queues behave as those
/// of SocketCAN.
class RemotePort {
 public:
  RemotePort(VirtualBus& bus, BusNodeIndex node, RemotePortOptions options, Random random);

  SendResult send(std::span<const Frame> frames, Time now) noexcept;
  std::size_t receive(std::span<StampedFrame> frames) noexcept;
  bool has_frames() const noexcept { return count_ != 0; }
  PortCondition condition() const noexcept;
  BusNodeIndex node() const noexcept { return node_; }
  const RemotePortOptions& options() const noexcept { return options_; }

  /// Returns the time at which a sleep until `until` ends, with jitter and stalls.
  Time wake_time(Time until, Time jitter) noexcept;

  // The following functions are for calls of the world.
  void on_wire(const WireFrame& wire) noexcept;
  void stall(Time from, Time until) noexcept {
    stalled_from_ = from;
    stalled_until_ = until;
  }
  void set_interface_down(bool down, Time now) noexcept;

 private:
  VirtualBus& bus_;
  BusNodeIndex node_;
  RemotePortOptions options_;
  Random random_;
  std::vector<StampedFrame> ring_;
  std::size_t head_ = 0;
  std::size_t count_ = 0;
  std::uint32_t overruns_ = 0;
  bool down_ = false;
  int last_error_ = 0;
  Time last_sync_echo_{};
  Time stalled_from_{};
  Time stalled_until_{};
};

}  // namespace takt::sim
