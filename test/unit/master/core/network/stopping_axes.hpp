#pragma once
#include <array>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "master/core/network/ordered_stop.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt::test {

using namespace std::chrono_literals;

inline constexpr std::int64_t operation_enabled = 0x0237;
inline constexpr std::int64_t quick_stop_active = 0x0217;
inline constexpr std::int64_t switch_on_disabled = 0x0250;

/// The stop of two axes, stepped every 2 ms. The positions change by `speed` counts per step. A
/// frame of each axis comes in every `every`-th step.
class Stop {
 public:
  explicit Stop(std::int64_t word = operation_enabled, BusPlan of = test::axes())
      : plan{std::move(of)}, machine{plan}, values(plan.layout.signals.size(), 0) {
    words = {word, word};
    machine.begin(now, nodes);
  }
  /// Begins again, after the axes were seen disabled and nothing could have enabled them.
  void begin_with_memory() {
    std::array<AxisMemory, 2> memory;
    for (AxisMemory& axis : memory) {
      for (int i = 0; i < 10; ++i) axis.look(switch_on_disabled, std::nullopt);
    }
    machine.call_off();
    machine.begin(now, nodes, OrderedStop::every_node, memory);
  }
  void step(int count = 1) {
    for (int i = 0; i < count; ++i) {
      now += 2ms;
      place[0] += speed[0];
      place[1] += speed[1];
      ++steps;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        if (every[axis] == 0 || steps % every[axis] != 0) continue;
        ++marks[axis].received;
        values[axis] = words[axis];
        values[2 + axis] = place[axis];
      }
      machine.step(now, {.received = {.values = values, .stale = stale, .marks = marks},
                         .exchanging = exchanging,
                         .nodes = nodes,
                         .disarmed = disarmed,
                         .network_stopped = stopped});
    }
  }
  void step_until(StopStage stage) {
    for (int i = 0; i < 10000 && machine.stage() != stage; ++i) step();
    ASSERT_EQ(machine.stage(), stage);
  }
  AxisVerdict verdict(std::size_t axis) const {
    return machine.axis(axis).verdict(now, exchanging[axis]);
  }

  BusPlan plan;
  OrderedStop machine;
  std::vector<std::int64_t> values;
  std::array<std::int64_t, 2> words{};
  std::array<std::int64_t, 2> speed{};
  std::array<std::int64_t, 2> place{};
  std::array<int, 2> every{1, 1};
  int steps = 0;
  std::array<PdoMark, 2> marks{};
  std::array<std::uint64_t, 1> stale{};
  std::array<bool, 2> exchanging{true, true};
  std::array<NodeStatus, 2> nodes{NodeStatus{.boot = BootState::ready, .boot_count = 1},
                                  NodeStatus{.boot = BootState::ready, .boot_count = 1}};
  bool disarmed = true;
  bool stopped = false;
  Time now = 1s;
};

}  // namespace takt::test
