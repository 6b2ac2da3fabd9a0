#include "master/linux/bus/frame_channel.hpp"

#include <cerrno>

#include "master/linux/bus_name.hpp"

namespace takt {

std::expected<FrameChannel, BusError> FrameChannel::open(std::string_view bus, BusMember member) {
  const BusName name = BusName::parse(bus);
  const auto wrap = [](auto port) -> std::expected<FrameChannel, BusError> {
    if (!port) return std::unexpected{port.error()};
    return FrameChannel{std::move(*port)};
  };
  switch (name.kind) {
    case BusName::Kind::unix_path:
      return wrap(UnixBusPort::open({.path = name.name, .member = member}));
    case BusName::Kind::can_interface:
      return wrap(
          SocketCanPort::open({.interface = name.name, .filters = {{.can_id = 0, .can_mask = 0}}}));
    case BusName::Kind::simulated:
      break;
  }
  std::string message{bus};
  message += ": this is not a bus of this machine (can0, unix:PATH)";
  return std::unexpected{BusError{std::move(message), EINVAL}};
}

SendResult FrameChannel::send(std::span<const Frame> frames) noexcept {
  return std::visit([frames](auto& port) { return port.send(frames); }, port_);
}

bool FrameChannel::receive(StampedFrame& frame, Time timeout) noexcept {
  const Time until = monotonic_now() + timeout;
  const auto fill = [this](auto& port) { count_ = port.receive(waiting_); };
  while (next_ == count_) {
    next_ = 0;
    std::visit(fill, port_);
    if (count_ > 0) break;
    if (monotonic_now() >= until) return false;
    std::visit([until](auto& port) { port.wait_frame(until); }, port_);
  }
  frame = waiting_[next_++];
  return true;
}

bool FrameChannel::sees(CobId id, std::uint8_t first, Time timeout) noexcept {
  const Time until = monotonic_now() + timeout;
  StampedFrame heard;
  for (Time left = timeout; left >= Time{}; left = until - monotonic_now()) {
    if (!receive(heard, left)) return false;
    const Frame& frame = heard.frame;
    if (frame.id == id && !frame.rtr && frame.length != 0 && frame.data[0] == first) return true;
  }
  return false;
}

PortCondition FrameChannel::condition() const noexcept {
  return std::visit([](const auto& port) { return port.condition(); }, port_);
}

}  // namespace takt
