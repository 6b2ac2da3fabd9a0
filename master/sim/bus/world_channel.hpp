#pragma once
#include <cstdint>

#include "eds_parser/values/time.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

enum class ChannelRead : std::uint8_t { frame, nothing, closed };

/// A channel for frames to and from a bus outside the simulation: a socket pair, SocketCAN or a
/// unix bus. Only one thread may use it.
class FrameChannel {
 public:
  virtual ~FrameChannel() = default;
  /// Returns false if the channel is closed permanently. Drops the frame if there is no room for
  /// it.
  virtual bool send(const Frame& frame) noexcept = 0;
  /// Waits at most `timeout` for one frame; 0 means no wait.
  virtual ChannelRead receive(Frame& frame, Time timeout) noexcept = 0;
  /// Receives a frame as receive() does, and also gives the monotonic time at which the frame was
  /// on the bus; 0 means unknown.
  virtual ChannelRead receive_stamped(StampedFrame& stamped, Time timeout) noexcept {
    stamped.when = Time{};
    return receive(stamped.frame, timeout);
  }
};

}  // namespace takt::sim
