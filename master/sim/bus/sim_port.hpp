#pragma once
#include <cstddef>
#include <span>

#include "eds_parser/values/time.hpp"
#include "master/rt/port.hpp"
#include "master/sim/bus/remote_port.hpp"
#include "master/sim/bus/world.hpp"

namespace takt::sim {

/// The Port of the bus loop in virtual time. Time passes only while the caller sleeps or waits;
/// computing takes no time. Frames leave in the order in which they were sent, as from a SocketCAN
/// queue.
class SimPort {
 public:
  explicit SimPort(World& world, RemotePortOptions options = {})
      : world_{world}, port_{world.attach(options)} {}

  Time now() noexcept { return world_.now(); }
  void sleep_until(Time until) noexcept {
    world_.advance_to(port_.wake_time(until, port_.options().wake_jitter));
  }
  void sleep_precisely_until(Time until) noexcept {
    world_.advance_to(port_.wake_time(until, port_.options().spin_jitter));
  }
  bool wait_frame(Time until) noexcept {
    const bool some = world_.advance_until_frame(port_, until);
    world_.advance_to(port_.wake_time(world_.now(), port_.options().wake_jitter));
    return some || port_.has_frames();
  }
  std::size_t receive(std::span<StampedFrame> frames) noexcept { return port_.receive(frames); }
  SendResult send(std::span<const Frame> frames) noexcept {
    return port_.send(frames, world_.now());
  }
  PortCondition condition() const noexcept { return port_.condition(); }

 private:
  World& world_;
  RemotePort& port_;
};
static_assert(Port<SimPort>);

}  // namespace takt::sim
