#include "master/core/ordered_stop.hpp"

#include <array>
#include <gtest/gtest.h>
#include <vector>

#include "test/unit/rt/small_plan.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// The stop of two axes, stepped every 2 ms.
class Stop {
 public:
  Stop() : plan{test::axes()}, machine{plan}, values(plan.layout.signals.size(), 0) {
    values[0] = values[1] = 0x0237;  // operation enabled
    machine.begin(now);
  }
  void step(int count = 1) {
    for (int i = 0; i < count; ++i) {
      now += 2ms;
      machine.step(now, {.values = values, .exchanging = exchanging, .network_stopped = stopped});
    }
  }
  void step_until(StopStage stage) {
    for (int i = 0; i < 10000 && machine.stage() != stage; ++i) step();
    ASSERT_EQ(machine.stage(), stage);
  }

  BusPlan plan;
  OrderedStop machine;
  std::vector<std::int64_t> values;
  std::array<bool, 2> exchanging{true, true};
  bool stopped = false;
  Time now = 1s;
};

TEST(OrderedStop, FindsTheAxesOfThePlan) {
  Stop stop;
  ASSERT_EQ(stop.machine.axes().size(), 2U);
  EXPECT_EQ(stop.machine.axes()[1].controlword, 5);
  EXPECT_EQ(stop.machine.axes()[1].statusword, 1);
}

TEST(OrderedStop, GoesFromFallbackToQuickStop) {
  Stop stop;
  EXPECT_EQ(stop.machine.stage(), StopStage::fallback);
  EXPECT_FALSE(stop.machine.controlword());
  stop.step_until(StopStage::quick_stop);
  EXPECT_EQ(stop.machine.controlword(), 0x0002);
  EXPECT_LT(stop.now - 1s, 20ms);
}

TEST(OrderedStop, GoesOnOnlyWhenEveryAxisIsDisabled) {
  Stop stop;
  stop.step_until(StopStage::quick_stop);
  stop.values[0] = 0x0250;  // switch on disabled
  stop.values[1] = 0x0217;  // quick stop active
  stop.step(100);
  EXPECT_EQ(stop.machine.stage(), StopStage::quick_stop);
  stop.values[1] = 0x0250;
  stop.step();
  EXPECT_EQ(stop.machine.stage(), StopStage::nmt);
}

TEST(OrderedStop, TakesTheVoltageFromAnAxisThatStaysInQuickStop) {
  Stop stop;
  stop.values[0] = stop.values[1] = 0x0217;  // 605A = 6: stays in quick stop active
  stop.step_until(StopStage::disable);
  EXPECT_EQ(stop.machine.controlword(), 0x0000);
  EXPECT_LE(stop.now - 1s, 3100ms);
  stop.values[0] = stop.values[1] = 0x0250;
  stop.step(3);
  EXPECT_EQ(stop.machine.stage(), StopStage::nmt);
}

TEST(OrderedStop, DoesNotWaitForAxesThatCannotBeReached) {
  Stop stop;
  stop.step_until(StopStage::quick_stop);
  stop.values[0] = 0x0250;
  stop.exchanging[1] = false;
  stop.step(3);
  EXPECT_EQ(stop.machine.stage(), StopStage::nmt);
}

TEST(OrderedStop, EndsWithinItsTimeWhateverHappens) {
  Stop stop;  // nobody answers, the network never stops
  stop.step_until(StopStage::done);
  EXPECT_LE(stop.now - 1s, 5s);
}

TEST(OrderedStop, EndsWhenTheNetworkHasStopped) {
  Stop stop;
  stop.values[0] = stop.values[1] = 0x0008;  // fault: no power
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
