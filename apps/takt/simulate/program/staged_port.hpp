#pragma once
#include <functional>
#include <span>
#include <utility>

#include "apps/takt/simulate/program/stage.hpp"
#include "master/rt/port.hpp"
#include "master/sim/bus/remote_port.hpp"
#include "master/sim/bus/world.hpp"

namespace takt {

/// The port of a bus thread in virtual time that runs beside other actors. Whenever the bus thread
/// sleeps, it lets those actors on the stage act that are due before it wakes. Therefore actors can
/// act between any two steps of the bus thread, like other threads of the same machine.
class StagedPort {
 public:
  /// Called with the frames that the master passes to the interface.
  using Sent = std::function<void(std::span<const Frame> frames, Time now)>;

  StagedPort(sim::World& world, sim::RemotePortOptions options, Stage& stage, Sent sent)
      : world_{world}, port_{world.attach(options)}, stage_{stage}, sent_{std::move(sent)} {}

  Time now() noexcept { return world_.now(); }
  void sleep_until(Time until) noexcept {
    pass_to(port_.wake_time(until, port_.options().wake_jitter));
  }
  void sleep_precisely_until(Time until) noexcept {
    pass_to(port_.wake_time(until, port_.options().spin_jitter));
  }
  bool wait_frame(Time until) noexcept {
    bool some = port_.has_frames();
    while (!some && world_.now() < until) {
      some = world_.advance_until_frame(port_, std::min(until, due()));
      if (!some && stage_.next() <= world_.now()) stage_.act(world_.now());
    }
    pass_to(port_.wake_time(world_.now(), port_.options().wake_jitter));
    return port_.has_frames();
  }
  std::size_t receive(std::span<StampedFrame> frames) noexcept { return port_.receive(frames); }
  SendResult send(std::span<const Frame> frames) noexcept {
    const SendResult result = port_.send(frames, world_.now());
    sent_(frames.first(result.sent), world_.now());
    return result;
  }
  PortCondition condition() const noexcept { return port_.condition(); }

 private:
  /// Returns the time of the next action. An actor that is overdue acts now, because time never
  /// goes back.
  Time due() const noexcept { return std::max(stage_.next(), world_.now()); }
  void pass_to(Time until) noexcept {
    for (Time at = due(); at <= until && at != never; at = due()) {
      world_.advance_to(at);
      stage_.act(at);
    }
    world_.advance_to(until);
  }

  sim::World& world_;
  sim::RemotePort& port_;
  Stage& stage_;
  Sent sent_;
};
static_assert(Port<StagedPort>);

}  // namespace takt
