#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string_view>
#include <variant>

#include "master/linux/bus_error.hpp"
#include "master/linux/can/socket_can.hpp"
#include "master/linux/unix_bus/unix_bus.hpp"

namespace takt {

/// Sends and receives frames for programs without real time: devices, dumps, tools. It receives all
/// frames that others send, but not its own. All calls come from one thread.
class FrameChannel {
 public:
  /// `bus` is the name of a CAN interface (`can0`, `vcan0`) or `unix:PATH`.
  static std::expected<FrameChannel, BusError> open(std::string_view bus,
                                                    BusMember member = BusMember::resident);
  /// Takes the devices' end of make_socket_pair_bus().
  explicit FrameChannel(UnixBusPort port) : port_{std::move(port)} {}
  explicit FrameChannel(SocketCanPort port) : port_{std::move(port)} {}

  /// Returns false if the interface is down or its buffers are full; the frame is lost.
  bool send(const Frame& frame) noexcept { return send(std::span{&frame, 1}).sent == 1; }
  SendResult send(std::span<const Frame> frames) noexcept;

  /// Takes the next frame and waits at most `timeout` for it (0 means no wait). Returns false if no
  /// frame came.
  bool receive(StampedFrame& frame, Time timeout) noexcept;

  /// Waits at most `timeout` for a frame with COB-ID `id` and first byte `first`. Returns true if
  /// it came. A frame that another socket of this machine has sent comes only after it was on the
  /// bus, however long it waits in the queue of the interface.
  bool sees(CobId id, std::uint8_t first, Time timeout) noexcept;

  PortCondition condition() const noexcept;

 private:
  std::variant<SocketCanPort, UnixBusPort> port_;
  std::array<StampedFrame, 64> waiting_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace takt
