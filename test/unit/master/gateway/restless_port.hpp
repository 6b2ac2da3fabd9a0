#pragma once
#include <chrono>
#include <span>

#include "master/rt/port.hpp"
#include "master/sim/bus/sim_port.hpp"

namespace takt::test {

/// The port of a CAN controller whose state changes in each cycle of 4 ms; each change makes one
/// event.
class RestlessPort {
 public:
  explicit RestlessPort(sim::SimPort& port) : port_{port} {}
  Time now() noexcept { return port_.now(); }
  void sleep_until(Time until) noexcept { port_.sleep_until(until); }
  void sleep_precisely_until(Time until) noexcept { port_.sleep_precisely_until(until); }
  bool wait_frame(Time until) noexcept { return port_.wait_frame(until); }
  std::size_t receive(std::span<StampedFrame> in) noexcept { return port_.receive(in); }
  SendResult send(std::span<const Frame> out) noexcept { return port_.send(out); }
  PortCondition condition() const noexcept {
    PortCondition condition = port_.condition();
    condition.error_passive = port_.now() / std::chrono::milliseconds{4} % 2 != 0;
    return condition;
  }

 private:
  sim::SimPort& port_;
};

}  // namespace takt::test
