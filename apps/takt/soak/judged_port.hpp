#pragma once
#include <span>

#include "apps/takt/soak/intruder.hpp"
#include "apps/takt/soak/judge/output_judge.hpp"
#include "master/sim/bus/sim_port.hpp"

namespace takt::soak {

/// Wraps the simulation's port: the judge sees each frame that the master sends, and the intruder
/// acts whenever the master sleeps.
class JudgedPort {
 public:
  JudgedPort(sim::SimPort& port, OutputJudge& judge, Intruder& intruder)
      : port_{port}, judge_{judge}, intruder_{intruder} {}

  Time now() noexcept { return port_.now(); }
  void sleep_until(Time until) noexcept {
    intruder_.act();
    port_.sleep_until(until);
  }
  void sleep_precisely_until(Time until) noexcept {
    intruder_.act();
    port_.sleep_precisely_until(until);
  }
  bool wait_frame(Time until) noexcept {
    intruder_.act();
    return port_.wait_frame(until);
  }
  std::size_t receive(std::span<StampedFrame> frames) noexcept { return port_.receive(frames); }
  SendResult send(std::span<const Frame> frames) noexcept {
    const SendResult result = port_.send(frames);
    judge_.sent(frames.first(result.sent), port_.now());
    return result;
  }
  PortCondition condition() const noexcept { return port_.condition(); }

 private:
  sim::SimPort& port_;
  OutputJudge& judge_;
  Intruder& intruder_;
};
static_assert(Port<JudgedPort>);

}  // namespace takt::soak
