#pragma once
#include <utility>

#include "master/linux/frame_channel.hpp"
#include "master/sim/frame_channel.hpp"

namespace takt {

/// The simulated devices' way onto a bus of this machine.
class DeviceChannel final : public sim::FrameChannel {
 public:
  explicit DeviceChannel(takt::FrameChannel channel) : channel_{std::move(channel)} {}

  bool send(const Frame& frame) noexcept override {
    channel_.send(frame);
    return !channel_.news().interface_down;
  }
  sim::ChannelRead receive(Frame& frame, Time timeout) noexcept override {
    StampedFrame stamped;
    if (!channel_.receive(stamped, timeout)) return sim::ChannelRead::nothing;
    frame = stamped.frame;
    return sim::ChannelRead::frame;
  }

 private:
  takt::FrameChannel channel_;
};

}  // namespace takt
