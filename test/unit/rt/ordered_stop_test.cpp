#include "master/core/ordered_stop.hpp"

#include <array>
#include <gtest/gtest.h>
#include <vector>

#include "test/unit/rt/small_plan.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t operation_enabled = 0x0237;
constexpr std::int64_t quick_stop_active = 0x0217;
constexpr std::int64_t switch_on_disabled = 0x0250;

/// The stop of two axes, stepped every 2 ms. The positions change by `speed` counts per step.
class Stop {
 public:
  explicit Stop(std::int64_t word = operation_enabled)
      : plan{test::axes()}, machine{plan}, values(plan.layout.signals.size(), 0) {
    values[0] = values[1] = word;
    machine.begin(now, nodes);
  }
  void step(int count = 1) {
    for (int i = 0; i < count; ++i) {
      now += 2ms;
      values[2] += speed[0];
      values[3] += speed[1];
      machine.step(now, {.values = values,
                         .stale = stale,
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
  std::array<std::int64_t, 2> speed{};
  std::array<std::uint64_t, 1> stale{};
  std::array<bool, 2> exchanging{true, true};
  std::array<NodeStatus, 2> nodes{NodeStatus{.boot = BootState::ready, .boot_count = 1},
                                  NodeStatus{.boot = BootState::ready, .boot_count = 1}};
  bool disarmed = true;
  bool stopped = false;
  Time now = 1s;
};

TEST(OrderedStop, FindsTheAxesOfThePlan) {
  Stop stop;
  ASSERT_EQ(stop.machine.axes().size(), 2U);
  EXPECT_EQ(stop.machine.axes()[1].controlword, 5);
  EXPECT_EQ(stop.machine.axes()[1].statusword, 1);
  EXPECT_EQ(stop.machine.axes()[1].position, 3);
  EXPECT_FALSE(stop.machine.axes()[1].velocity);
}

TEST(OrderedStop, GoesFromFallbackToQuickStop) {
  Stop stop;
  stop.speed = {100, 100};
  EXPECT_EQ(stop.machine.stage(), StopStage::fallback);
  EXPECT_FALSE(stop.machine.controlword(0));
  stop.step();
  EXPECT_EQ(stop.machine.stage(), StopStage::fallback);
  EXPECT_EQ(stop.machine.controlword(0), 0x0002) << "whatever its fallback is";
  stop.step_until(StopStage::quick_stop);
  EXPECT_EQ(stop.machine.controlword(0), 0x0002);
  EXPECT_LT(stop.now - 1s, 20ms);
}

TEST(OrderedStop, DisablesAnAxisWhenItWasSeenAtStandstill) {
  Stop stop;
  stop.speed = {100, 100};
  stop.values[0] = stop.values[1] = quick_stop_active;  // 605A = 6: the axis stays in this state
  stop.step(200);
  EXPECT_EQ(stop.machine.controlword(0), 0x0002);

  stop.speed[0] = 0;
  stop.step(20);
  EXPECT_EQ(stop.machine.controlword(0), 0x0002) << "40 ms at rest are too few";
  stop.step(20);
  EXPECT_EQ(stop.machine.controlword(0), 0x0000);
  EXPECT_EQ(stop.machine.controlword(1), 0x0002) << "the other one still moves";
}

TEST(OrderedStop, GoesOnOnlyWhenEveryAxisIsDisabled) {
  Stop stop;
  stop.step(50);
  stop.values[0] = switch_on_disabled;
  stop.step(100);
  EXPECT_EQ(stop.machine.stage(), StopStage::quick_stop);
  EXPECT_EQ(stop.machine.result(), StopResult::under_way);
  stop.values[1] = switch_on_disabled;
  stop.step(2);
  EXPECT_EQ(stop.machine.stage(), StopStage::nmt);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

TEST(OrderedStop, ConfirmsAxesThatWereDisabledAtTheBeginning) {
  Stop stop{switch_on_disabled};
  stop.speed = {100, 0};  // a person turns the axis by hand
  stop.step(10);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

TEST(OrderedStop, ConfirmsADriveThatDisablesItselfAtTheEndOfItsRamp) {
  Stop stop;
  for (stop.speed = {200, 200}; stop.speed[0] > 0; stop.speed[0] = stop.speed[1] -= 1) stop.step();
  stop.values[0] = stop.values[1] = switch_on_disabled;  // 605A = 2
  stop.step(10);
  EXPECT_EQ(stop.machine.stage(), StopStage::quick_stop) << "is it at rest?";
  stop.step(30);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

TEST(OrderedStop, DoesNotConfirmADriveThatCoasts) {
  Stop stop;
  stop.speed = {150, 0};
  stop.step(20);
  stop.values[0] = stop.values[1] = switch_on_disabled;  // 605A = 0
  stop.step(100);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::moving);
  EXPECT_EQ(stop.machine.axis(0).velocity(), 75'000);  // 150 counts in 2 ms
  EXPECT_EQ(stop.verdict(1), AxisVerdict::stopped);
}

TEST(OrderedStop, DoesNotDisableAMovingAxisAsLongAsThereIsTime) {
  Stop stop;
  stop.speed = {150, 0};
  while (stop.now - 1s < 3950ms) {
    stop.step();
    if (stop.machine.stage() != StopStage::fallback) {
      ASSERT_EQ(stop.machine.controlword(0), 0x0002);
    }
  }
}

TEST(OrderedStop, TellsAtWhichVelocityAnAxisWasDisabled) {
  Stop stop;
  stop.speed = {150, 0};
  stop.step_until(StopStage::disable);
  EXPECT_EQ(stop.machine.controlword(0), 0x0000);
  stop.values[0] = stop.values[1] = switch_on_disabled;
  stop.speed = {};
  stop.step_until(StopStage::nmt);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::moving);
  EXPECT_EQ(stop.machine.axis(0).velocity(), 75'000);
}

TEST(OrderedStop, TellsAnAxisThatStaysEnabled) {
  Stop stop;
  stop.step_until(StopStage::nmt);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::enabled);
}

TEST(OrderedStop, TellsForHowLongAnAxisGaveNoAnswer) {
  Stop stop;
  stop.values[0] = switch_on_disabled;
  stop.step(10);
  stop.stale[0] = 0b1010;  // statusword and position of the second axis
  stop.step_until(StopStage::nmt);
  EXPECT_EQ(stop.verdict(1), AxisVerdict::silent);
  EXPECT_GT(stop.machine.axis(1).silence(stop.now), 4s);
}

TEST(OrderedStop, DoesNotTakeAnOldStatuswordForAnAnswer) {
  Stop stop;
  stop.step(10);
  stop.stale[0] = 0b1111;
  stop.values[0] = stop.values[1] = switch_on_disabled;
  stop.step(200);
  EXPECT_EQ(stop.machine.result(), StopResult::under_way);
}

TEST(OrderedStop, NeverConfirmsADriveWhoseNodeIsLost) {
  Stop stop;
  stop.step(10);
  stop.values[0] = stop.values[1] = switch_on_disabled;
  stop.exchanging[1] = false;
  stop.step(300);
  EXPECT_EQ(stop.machine.stage(), StopStage::quick_stop);
  stop.step(300);
  EXPECT_EQ(stop.machine.stage(), StopStage::nmt) << "the others wait a second for it";
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(1), AxisVerdict::lost);
}

TEST(OrderedStop, HasNothingToConfirmOfANodeThatNeverWasReady) {
  Stop stop{switch_on_disabled};
  stop.exchanging[1] = false;
  stop.nodes[1] = NodeStatus{.boot = BootState::failed};
  stop.machine.call_off();
  stop.machine.begin(stop.now, stop.nodes);
  stop.step(10);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

TEST(OrderedStop, TakesWhatAnSdoHasReadWhereNoPdoBringsIt) {
  Stop stop;
  stop.exchanging = {true, false};
  stop.values[0] = switch_on_disabled;
  for (int i = 0; i < 20; ++i) {
    stop.machine.take(1,
                      AxisSample{.statusword = quick_stop_active, .velocity = {}, .position = {}});
    stop.machine.take(1, AxisSample{.statusword = {}, .velocity = 3, .position = {}});
    stop.step(5);
  }
  EXPECT_EQ(stop.machine.axis(1).state(), AxisState::standing);
  stop.machine.take(1,
                    AxisSample{.statusword = switch_on_disabled, .velocity = {}, .position = {}});
  stop.step(2);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

TEST(OrderedStop, WaitsUntilEverythingIsDisarmed) {
  Stop stop{switch_on_disabled};
  stop.disarmed = false;
  stop.step_until(StopStage::disarm);
  stop.step(5);
  EXPECT_EQ(stop.machine.stage(), StopStage::disarm);
  stop.disarmed = true;
  stop.step();
  EXPECT_EQ(stop.machine.stage(), StopStage::nmt);
}

TEST(OrderedStop, LeavesEverythingArmedWhereAnAxisIsNotConfirmed) {
  Stop stop;
  stop.disarmed = false;
  while (stop.machine.stage() != StopStage::done) {
    stop.step();
    ASSERT_NE(stop.machine.stage(), StopStage::disarm);
  }
}

TEST(OrderedStop, EndsWithinItsTimeWhateverHappens) {
  Stop stop;  // nobody answers, the network never stops
  stop.step_until(StopStage::done);
  EXPECT_LE(stop.now - 1s, 5s);
}

TEST(OrderedStop, EndsWhenTheNetworkHasStopped) {
  Stop stop{0x0008};  // fault: no power
  stop.step_until(StopStage::nmt);
  stop.step(5);
  EXPECT_EQ(stop.machine.stage(), StopStage::nmt);
  stop.stopped = true;
  stop.step();
  EXPECT_EQ(stop.machine.stage(), StopStage::done);
}

TEST(OrderedStop, CountsOnlyPowerlessStatesAsDisabled) {
  EXPECT_TRUE(OrderedStop::disabled(0x0250));   // switch on disabled
  EXPECT_TRUE(OrderedStop::disabled(0x0000));   // not ready to switch on
  EXPECT_TRUE(OrderedStop::disabled(0x0238));   // fault
  EXPECT_TRUE(OrderedStop::disabled(0x0231));   // ready to switch on
  EXPECT_FALSE(OrderedStop::disabled(0x0233));  // switched on
  EXPECT_FALSE(OrderedStop::disabled(0x0237));  // operation enabled
  EXPECT_FALSE(OrderedStop::disabled(0x0217));  // quick stop active
  EXPECT_FALSE(OrderedStop::disabled(0x021F));  // fault reaction active
}

}  // namespace
}  // namespace takt
