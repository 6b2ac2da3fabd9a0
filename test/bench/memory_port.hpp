#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "master/rt/port.hpp"

namespace takt::bench {

/// A port in memory: every device answers each SYNC at once. The port counts the calls that are
/// system calls with a real port. It calls `Hook` when the loop enters and leaves the port, when
/// the loop has received, and when the loop reads the clock.
template <class Hook>
class MemoryPort {
 public:
  explicit MemoryPort(unsigned nodes, Hook hook = {}) : hook_{hook} {
    for (std::uint32_t node = 1; node <= nodes; ++node) {
      answers_.push_back(
          {.frame = make_frame(CobId::base(0x180 + node), {1, 2, 3, 4, 5, 6, 7, 8})});
      heartbeats_.push_back({.frame = make_frame(CobId::base(0x700 + node), {5})});
    }
  }

  Time now() noexcept {
    hook_.on_now();
    return now_;
  }
  void sleep_until(Time until) noexcept {
    call([&] { pass(until); });
  }
  void sleep_precisely_until(Time until) noexcept {
    call([&] { pass(until); });
  }
  bool wait_frame(Time until) noexcept {
    call([&] { pass(until); });
    return false;
  }
  std::size_t receive(std::span<StampedFrame> in) noexcept {
    std::size_t count = 0;
    call([&] {
      const std::vector<StampedFrame>& from = alive ? answers_ : heartbeats_;
      const std::size_t all = pending_ ? from.size() - silent : 0;
      for (; count < all; ++count) in[count] = {.frame = from[count].frame, .when = now_};
      pending_ = false;
    });
    hook_.on_received();
    return count;
  }
  SendResult send(std::span<const Frame> out) noexcept {
    call([&] { pending_ |= out.front().id == CobId::base(0x080); });
    return {.sent = out.size()};
  }
  PortCondition condition() const noexcept { return {}; }

  std::uint64_t calls = 0;
  bool alive = false;      ///< false: heartbeats instead of PDOs
  std::size_t silent = 0;  ///< number of devices that do not answer

 private:
  template <class F>
  void call(F&& act) noexcept {
    hook_.enter();
    ++calls;
    act();
    hook_.leave();
  }
  void pass(Time until) noexcept { now_ = std::max(now_, until); }

  Hook hook_;
  std::vector<StampedFrame> answers_;
  std::vector<StampedFrame> heartbeats_;
  Time now_ = std::chrono::seconds{1};
  bool pending_ = false;
};

}  // namespace takt::bench
