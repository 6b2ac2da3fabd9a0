#pragma once
#include <utility>

#include "master/linux/bus/frame_channel.hpp"
#include "master/sim/bus/world_channel.hpp"

namespace takt {

/// Connects the simulated devices to a bus of this machine. While the interface is down, frames are
/// dropped without an error, because the interface may come back.
class DeviceChannel final : public sim::FrameChannel {
 public:
  explicit DeviceChannel(takt::FrameChannel channel) : channel_{std::move(channel)} {}

  bool send(const Frame& frame) noexcept override {
    channel_.send(frame);
    return true;
  }
  sim::ChannelRead receive(Frame& frame, Time timeout) noexcept override {
    StampedFrame stamped;
    const sim::ChannelRead read = receive_stamped(stamped, timeout);
    frame = stamped.frame;
    return read;
  }
  sim::ChannelRead receive_stamped(StampedFrame& stamped, Time timeout) noexcept override {
    const bool some = channel_.receive(stamped, timeout);
    return some ? sim::ChannelRead::frame : sim::ChannelRead::nothing;
  }

 private:
  takt::FrameChannel channel_;
};

}  // namespace takt
