#pragma once
#include <chrono>
#include <functional>
#include <span>

#include "master/linux/bus/frame_channel.hpp"
#include "master/linux/clock.hpp"

namespace takt {

/// Sends all frames. Waits while the transmit queue is full, because most interfaces hold only ten
/// frames, and passes the frames that arrive meanwhile to `hear`. Returns false if the queue stays
/// full for two seconds: no node acknowledges the frames.
inline bool send_all(FrameChannel& channel, std::span<const Frame> frames,
                     const std::function<void(const Frame& frame)>& hear) {
  const Time limit = monotonic_now() + std::chrono::seconds{2};
  for (;;) {
    frames = frames.subspan(channel.send(frames).sent);
    if (frames.empty()) return true;
    if (monotonic_now() > limit) return false;
    StampedFrame heard;
    if (channel.receive(heard, std::chrono::milliseconds{1})) hear(heard.frame);
  }
}

}  // namespace takt
