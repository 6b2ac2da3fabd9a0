#pragma once
#include <cstddef>
#include <span>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"
#include "master/linux/clock.hpp"
#include "master/rt/port.hpp"
#include "master/sim/world.hpp"

namespace takt {

/// `--bus sim`: the devices of the plan as a Port, in real time and inside the bus thread. Each
/// call first lets the world catch up with the clock, so nothing has to be scheduled beside the
/// master. A bus thread that is held up holds the devices up too: what a stalled machine does to a
/// simulation would tell nothing about a bus.
class SimulatedBus {
 public:
  SimulatedBus(std::span<const DeviceTable> devices, const BusPlan& plan, Time spin);

  Time now() const noexcept { return monotonic_now(); }
  void sleep_until(Time until) noexcept;
  void sleep_precisely_until(Time until) noexcept;
  bool wait_frame(Time until) noexcept;
  std::size_t receive(std::span<StampedFrame> frames) noexcept;
  SendResult send(std::span<const Frame> frames) noexcept;
  PortNews news() const noexcept;

 private:
  void catch_up(Time expected) noexcept;
  Time on_the_clock(Time world_time) const noexcept;

  sim::World world_;
  sim::RemotePort& port_;
  Time spin_;
  Time caught_up_;     // monotonic, of the newest call
  Time start_;         // monotonic time of the world's time 0
  Time held_at_{};     // world time of the newest hold-up
  Time start_before_;  // start_ before it
};
static_assert(Port<SimulatedBus>);

}  // namespace takt
