#include "master/sim/realtime_world.hpp"

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

RealtimeWorld::RealtimeWorld(std::span<const DeviceTable> devices, WorldOptions options,
                             FrameChannel& channel)
    : world_{devices, std::move(options)},
      port_{world_.attach({.tx_queue = 4096, .rx_queue = 4096})},
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
  Time start = monotonic();
  while (!stop_.load(std::memory_order_acquire)) {
    const Time behind = monotonic() - start - world_.now();
    if (behind > longest_stall) start += behind;  // this process was stopped: so were the devices
    world_.advance_to(monotonic() - start);
    if (!carry_out()) break;
    const Time wait = std::clamp(world_.next_event() - (monotonic() - start), Time{}, longest_wait);
    Frame frame;
    ChannelRead read = channel_.receive(frame, wait);
    world_.advance_to(monotonic() - start);
    while (read == ChannelRead::frame) {
      port_.send({&frame, 1}, world_.now());
      read = channel_.receive(frame, Time{});
    }
    if (read == ChannelRead::closed) break;
  }
  failed_.store(!stop_.load(std::memory_order_acquire), std::memory_order_release);
}

bool RealtimeWorld::carry_out() noexcept {
  StampedFrame stamped;
  while (port_.receive({&stamped, 1}) == 1) {
    if (!channel_.send(stamped.frame)) return false;
  }
  return true;
}

}  // namespace takt::sim
