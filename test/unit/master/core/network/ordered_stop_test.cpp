#include "master/core/network/ordered_stop.hpp"

#include "test/unit/master/core/network/stopping_axes.hpp"

namespace takt::test {
namespace {

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
  stop.words[0] = stop.words[1] = quick_stop_active;  // 605A = 6: the axis stays in this state
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
  stop.words[0] = switch_on_disabled;
  stop.step(100);
  EXPECT_EQ(stop.machine.stage(), StopStage::quick_stop);
  EXPECT_EQ(stop.machine.result(), StopResult::under_way);
  stop.words[1] = switch_on_disabled;
  stop.step(2);
  EXPECT_EQ(stop.machine.stage(), StopStage::nmt);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

TEST(OrderedStop, ConfirmsAxesThatWereDisabledAtTheBeginning) {
  Stop stop{switch_on_disabled};
  stop.speed = {100, 0};  // a person turns the axis by hand
  stop.begin_with_memory();
  stop.step(10);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

TEST(OrderedStop, LeavesTheFallbackOnlyToAnAxisThatWasDisabledBefore) {
  Stop stop{switch_on_disabled};
  stop.begin_with_memory();
  stop.step();
  EXPECT_FALSE(stop.machine.controlword(0)) << "its fallback";

  Stop unknown;
  unknown.every = {0, 0};
  unknown.step();
  EXPECT_EQ(unknown.machine.controlword(0), 0x0002) << "it may be enabled";
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

TEST(OrderedStop, ReportsAtWhichVelocityAnAxisWasDisabled) {
  Stop stop;
  stop.speed = {150, 0};
  stop.step_until(StopStage::disable);
  EXPECT_EQ(stop.machine.controlword(0), 0x0000);
  stop.words[0] = stop.words[1] = switch_on_disabled;
  stop.speed = {};
  stop.step_until(StopStage::nmt);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::moving);
  EXPECT_EQ(stop.machine.axis(0).velocity(), 75'000);
}

TEST(OrderedStop, ReportsAnAxisThatStaysEnabled) {
  Stop stop;
  stop.step_until(StopStage::nmt);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::enabled);
}

TEST(OrderedStop, ReportsForHowLongAnAxisGaveNoAnswer) {
  Stop stop;
  stop.words[0] = switch_on_disabled;
  stop.step(10);
  stop.every = {1, 0};
  stop.step_until(StopStage::nmt);
  EXPECT_EQ(stop.verdict(1), AxisVerdict::silent);
  EXPECT_GT(stop.machine.axis(1).silence(stop.now), 4s);
}

TEST(OrderedStop, NeverConfirmsADriveWhoseNodeIsLost) {
  Stop stop;
  stop.step(10);
  stop.words[0] = stop.words[1] = switch_on_disabled;
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
  stop.begin_with_memory();
  stop.step(10);
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
}  // namespace takt::test
