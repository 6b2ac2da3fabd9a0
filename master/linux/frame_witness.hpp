#pragma once
#include <cstdint>
#include <expected>
#include <string_view>

#include "master/linux/frame_channel.hpp"

namespace takt {

/// Sees that a frame which this machine sends has been on the bus: another socket hears it only
/// then, whatever still waits in the queue of the interface. One thread.
class FrameWitness {
 public:
  /// Before the frame is sent.
  static std::expected<FrameWitness, BusError> open(std::string_view bus);

  /// Waits for a frame of `id` whose first byte is `first`, for at most `timeout`.
  bool sees(CobId id, std::uint8_t first, Time timeout) noexcept;

 private:
  explicit FrameWitness(FrameChannel channel) : channel_{std::move(channel)} {}
  FrameChannel channel_;
};

}  // namespace takt
