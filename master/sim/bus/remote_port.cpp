#include "master/sim/bus/remote_port.hpp"

#include <algorithm>
#include <cerrno>

namespace takt::sim {

RemotePort::RemotePort(VirtualBus& bus, BusNodeIndex node, RemotePortOptions options, Random random)
    : bus_{bus}, node_{node}, options_{options}, random_{random} {
  ring_.resize(std::max<std::size_t>(options_.rx_queue, 1));
}

SendResult RemotePort::send(std::span<const Frame> frames, Time now) noexcept {
  SendResult result;
  if (frames.empty()) return result;
  if (down_ || bus_.node(node_).bus_off) {
    result.error = last_error_ = ENETDOWN;
    return result;
  }
  for (const Frame& frame : frames) {
    if (!bus_.queue(node_, frame, now)) {
      result.error = last_error_ = ENOBUFS;
      return result;
    }
    ++result.sent;
  }
  return result;
}

std::size_t RemotePort::receive(std::span<StampedFrame> frames) noexcept {
  const std::size_t taken = std::min(frames.size(), count_);
  for (std::size_t i = 0; i < taken; ++i) {
    frames[i] = ring_[head_];
    head_ = head_ + 1 == ring_.size() ? 0 : head_ + 1;
  }
  count_ -= taken;
  return taken;
}

PortCondition RemotePort::condition() const noexcept {
  const BusNode& node = bus_.node(node_);
  const std::uint64_t frames = bus_.counters().frames;
  return {.interface_down = down_,
          .error_passive = node.error_passive(frames),
          .bus_off = node.bus_off,
          .receive_overruns = overruns_,
          .error_frames = node.error_frames,
          .tx_error_counter =
              static_cast<std::uint8_t>(std::min<std::uint32_t>(node.transmit_errors, 255)),
          .rx_error_counter = static_cast<std::uint8_t>(node.receive_errors(frames)),
          .last_error = last_error_,
          .since_1970 = options_.epoch,
          .last_sync_echo = last_sync_echo_};
}

Time RemotePort::wake_time(Time until, Time jitter) noexcept {
  if (jitter > Time{}) {
    until += Time{
        static_cast<Time::rep>(random_.next() % static_cast<std::uint64_t>(jitter.count() + 1))};
  }
  if (until >= stalled_from_ && until < stalled_until_) return stalled_until_;
  return until;
}

void RemotePort::on_wire(const WireFrame& wire) noexcept {
  if (down_) return;
  if (wire.sender == node_) {
    if (wire.frame.id == options_.sync && !wire.frame.rtr) last_sync_echo_ = wire.end;
    return;
  }
  if (count_ == ring_.size()) {
    ++overruns_;
    return;
  }
  std::size_t tail = head_ + count_;
  if (tail >= ring_.size()) tail -= ring_.size();
  ring_[tail] = {.frame = wire.frame, .when = wire.end};
  ++count_;
}

void RemotePort::set_interface_down(bool down, Time now) noexcept {
  down_ = down;
  bus_.set_powered(node_, !down, now);
  if (down) last_error_ = ENETDOWN;
}

}  // namespace takt::sim
