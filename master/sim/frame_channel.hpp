#pragma once
#include <cstdint>

#include "eds_parser/table/time.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

enum class ChannelRead : std::uint8_t { frame, nothing, closed };

/// Frames to and from a bus outside: a socket pair, SocketCAN, a unix bus. Used by one thread.
class FrameChannel {
 public:
  virtual ~FrameChannel() = default;
  /// False: the channel is closed for good. A frame that finds no room is dropped.
  virtual bool send(const Frame& frame) noexcept = 0;
  /// Waits at most `timeout` (0: not at all) for one frame.
  virtual ChannelRead receive(Frame& frame, Time timeout) noexcept = 0;
  /// The same with the monotonic time when the frame was on the bus; 0: not known.
  virtual ChannelRead receive_stamped(StampedFrame& stamped, Time timeout) noexcept {
    stamped.when = Time{};
    return receive(stamped.frame, timeout);
  }
};

}  // namespace takt::sim
