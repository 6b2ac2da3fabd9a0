#pragma once
#include <cstdint>
#include <expected>
#include <string_view>

#include "master/linux/bus/frame_channel.hpp"

namespace takt {

/// Confirms that a frame sent by this machine has been on the bus. Another socket receives the
/// frame only then, however long it waits in the queue of the interface. One thread.
class FrameWitness {
 public:
  /// Must be called before the frame is sent.
  static std::expected<FrameWitness, BusError> open(std::string_view bus);

  /// Waits at most `timeout` for a frame with COB-ID `id` and first byte `first`. Returns true if
  /// it came.
  bool sees(CobId id, std::uint8_t first, Time timeout) noexcept;

 private:
  explicit FrameWitness(FrameChannel channel) : channel_{std::move(channel)} {}
  FrameChannel channel_;
};

}  // namespace takt
