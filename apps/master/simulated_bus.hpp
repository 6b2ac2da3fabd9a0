#pragma once
#include <cstddef>
#include <span>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/device_table.hpp"
#include "master/linux/clock.hpp"
#include "master/rt/port.hpp"
#include "master/sim/bus/world.hpp"

namespace takt {

/// The bus of `--bus sim`: simulates the devices of the plan behind a Port, in real time and inside
/// the bus thread. Each call first advances the world to the current time, so no further thread is
/// needed. If the machine stalls the bus thread, the devices stall too: a simulation that
/// continued alone would not behave as a real bus.
class SimulatedBus {
 public:
  SimulatedBus(std::span<const DeviceTable> devices, const BusPlan& plan, Time spin);

  Time now() const noexcept { return monotonic_now(); }
  void sleep_until(Time until) noexcept;
  void sleep_precisely_until(Time until) noexcept;
  bool wait_frame(Time until) noexcept;
  std::size_t receive(std::span<StampedFrame> frames) noexcept;
  SendResult send(std::span<const Frame> frames) noexcept;
  PortCondition condition() const noexcept;

 private:
  void catch_up(Time expected) noexcept;
  Time on_the_clock(Time world_time) const noexcept;

  sim::World world_;
  sim::RemotePort& port_;
  Time spin_;
  Time caught_up_;     // monotonic time of the newest call
  Time start_;         // monotonic time of the world's time 0
  Time held_at_{};     // world time of the newest stall
  Time start_before_;  // value of start_ before the newest stall
};
static_assert(Port<SimulatedBus>);

}  // namespace takt
