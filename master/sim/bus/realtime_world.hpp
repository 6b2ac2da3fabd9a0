#pragma once
#include <atomic>
#include <span>
#include <thread>

#include "eds_parser/table/device_table.hpp"
#include "master/sim/bus/world.hpp"
#include "master/sim/bus/world_channel.hpp"

namespace takt::sim {

/// Runs the devices of a World in real time. A thread advances the World with the monotonic clock
/// and carries frames between the World and a channel. The virtual bus between them delays frames
/// as a wire of the configured bit rate would.
class RealtimeWorld {
 public:
  /// The channel must outlive this object.
  RealtimeWorld(std::span<const DeviceTable> devices, const WorldOptions& options,
                FrameChannel& channel);
  ~RealtimeWorld();
  RealtimeWorld(const RealtimeWorld&) = delete;
  RealtimeWorld& operator=(const RealtimeWorld&) = delete;

  void start();
  /// Ends the thread within about 10 ms. The destructor does the same.
  void stop() noexcept;
  /// Returns true if the channel is gone (interface removed, peer closed) and the thread has ended.
  bool failed() const noexcept { return failed_.load(std::memory_order_acquire); }

 private:
  void run() noexcept;
  bool carry_in(Time wait) noexcept;
  bool carry_out() noexcept;

  World world_;
  RemotePort& port_;
  FrameChannel& channel_;
  Time start_{};  ///< monotonic time of the world's time 0
  std::atomic<bool> stop_{false};
  std::atomic<bool> failed_{false};
  std::thread thread_;
};

}  // namespace takt::sim
