#include "apps/master/simulated_bus.hpp"

#include <algorithm>
#include <chrono>

namespace takt {
namespace {

/// A larger delay counts as a stall of the machine. A smaller one is an ordinary delay by the
/// scheduler, which devices on a real bus would also see.
constexpr Time longest_lag = std::chrono::milliseconds{1};

}  // namespace

SimulatedBus::SimulatedBus(std::span<const DeviceTable> devices, const BusPlan& plan, Time spin)
    : world_{devices, {.bitrate = plan.bitrate}},
      port_{world_.attach({.sync = plan.cycle.sync_cob_id})},
      spin_{spin},
      caught_up_{monotonic_now()},
      start_{caught_up_},
      start_before_{caught_up_} {}

void SimulatedBus::sleep_until(Time until) noexcept {
  takt::sleep_until(until);
  catch_up(std::max(until, caught_up_));
}

void SimulatedBus::sleep_precisely_until(Time until) noexcept {
  takt::sleep_precisely_until(until, spin_);
  catch_up(std::max(until, caught_up_));
}

bool SimulatedBus::wait_frame(Time until) noexcept {
  catch_up(caught_up_);
  while (!port_.has_frames()) {
    if (caught_up_ >= until) return false;
    const Time next = world_.next_event();
    sleep_until(next == never ? until : std::min(until, start_ + next));
  }
  return true;
}

std::size_t SimulatedBus::receive(std::span<StampedFrame> frames) noexcept {
  catch_up(caught_up_);
  const std::size_t received = port_.receive(frames);
  for (StampedFrame& frame : frames.first(received)) frame.when = on_the_clock(frame.when);
  return received;
}

SendResult SimulatedBus::send(std::span<const Frame> frames) noexcept {
  catch_up(caught_up_);
  return port_.send(frames, world_.now());
}

PortCondition SimulatedBus::condition() const noexcept {
  PortCondition condition = port_.condition();
  condition.since_1970 = realtime_offset();
  if (condition.last_sync_echo != Time{})
    condition.last_sync_echo = on_the_clock(condition.last_sync_echo);
  return condition;
}

/// `expected` is the time at which this call would have come on an otherwise idle machine.
void SimulatedBus::catch_up(Time expected) noexcept {
  caught_up_ = monotonic_now();
  if (caught_up_ - expected > longest_lag) {
    world_.advance_to(expected - start_);
    held_at_ = world_.now();
    start_before_ = start_;
    start_ = caught_up_ - held_at_;
  }
  world_.advance_to(caught_up_ - start_);
}

Time SimulatedBus::on_the_clock(Time world_time) const noexcept {
  return world_time + (world_time <= held_at_ ? start_before_ : start_);
}

}  // namespace takt
