#include "master/sim/bus/realtime_world.hpp"

#include <algorithm>
#include <chrono>

namespace takt::sim {
namespace {

constexpr Time longest_wait = std::chrono::milliseconds{10};
constexpr Time longest_stall = std::chrono::seconds{1};

Time monotonic() noexcept {
  return std::chrono::duration_cast<Time>(std::chrono::steady_clock::now().time_since_epoch());
}

}  // namespace

RealtimeWorld::RealtimeWorld(std::span<const DeviceTable> devices, const WorldOptions& options,
                             FrameChannel& channel)
    : world_{devices, options},
      port_{world_.attach({.tx_queue = 4096, .rx_queue = 4096, .relays = true})},
      channel_{channel} {}

RealtimeWorld::~RealtimeWorld() { stop(); }

void RealtimeWorld::start() {
  if (!thread_.joinable()) thread_ = std::thread{[this] { run(); }};
}

void RealtimeWorld::stop() noexcept {
  stop_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
}

void RealtimeWorld::run() noexcept {
  start_ = monotonic();
  while (!stop_.load(std::memory_order_acquire)) {
    const Time behind = monotonic() - start_ - world_.now();
    if (behind > longest_stall) start_ += behind;  // this process and the devices did not run
    const Time wait =
        std::clamp(world_.next_event() - (monotonic() - start_), Time{}, longest_wait);
    if (!carry_in(wait) || !carry_out()) break;
  }
  failed_.store(!stop_.load(std::memory_order_acquire), std::memory_order_release);
}

/// Delivers each received frame at the time at which it was received, and then advances to the
/// present. Because of this, the devices get every frame in time even if the thread wakes up late.
bool RealtimeWorld::carry_in(Time wait) noexcept {
  StampedFrame stamped;
  ChannelRead read = channel_.receive_stamped(stamped, wait);
  Time quiet_until = monotonic();
  while (read == ChannelRead::frame) {
    const Time when = stamped.when == Time{} ? quiet_until : std::min(stamped.when, quiet_until);
    world_.advance_to(when - start_);
    port_.send({&stamped.frame, 1}, world_.now());
    quiet_until = monotonic();
    read = channel_.receive_stamped(stamped, Time{});
  }
  world_.advance_to(quiet_until - start_);
  return read != ChannelRead::closed;
}

bool RealtimeWorld::carry_out() noexcept {
  StampedFrame stamped;
  while (port_.receive({&stamped, 1}) == 1) {
    if (!channel_.send(stamped.frame)) return false;
  }
  return true;
}

}  // namespace takt::sim
