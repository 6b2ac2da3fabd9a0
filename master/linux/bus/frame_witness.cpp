#include "master/linux/bus/frame_witness.hpp"

#include "master/linux/clock.hpp"

namespace takt {

std::expected<FrameWitness, BusError> FrameWitness::open(std::string_view bus) {
  auto channel = FrameChannel::open(bus, BusMember::guest);
  if (!channel) return std::unexpected{channel.error()};
  return FrameWitness{std::move(*channel)};
}

bool FrameWitness::sees(CobId id, std::uint8_t first, Time timeout) noexcept {
  const Time until = monotonic_now() + timeout;
  StampedFrame heard;
  for (Time left = timeout; left >= Time{}; left = until - monotonic_now()) {
    if (!channel_.receive(heard, left)) return false;
    const Frame& frame = heard.frame;
    if (frame.id == id && !frame.rtr && frame.length != 0 && frame.data[0] == first) return true;
  }
  return false;
}

}  // namespace takt
