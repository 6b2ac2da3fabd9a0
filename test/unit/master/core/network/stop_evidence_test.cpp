// Which values show the ordered stop that an axis is at standstill, and which values do not.
#include "test/unit/master/core/network/stopping_axes.hpp"

namespace takt::test {
namespace {

TEST(OrderedStop, ConfirmsADriveThatDisablesItselfAtTheEndOfItsRamp) {
  Stop stop;
  for (stop.speed = {200, 200}; stop.speed[0] > 0; stop.speed[0] = stop.speed[1] -= 1) stop.step();
  stop.words[0] = stop.words[1] = switch_on_disabled;  // 605A = 2
  stop.step(10);
  EXPECT_EQ(stop.machine.stage(), StopStage::quick_stop) << "is it at rest?";
  stop.step(30);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

TEST(OrderedStop, DoesNotConfirmADriveThatCoasts) {
  Stop stop;
  stop.speed = {150, 0};
  stop.step(20);
  stop.words[0] = stop.words[1] = switch_on_disabled;  // 605A = 0
  stop.step(100);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::moving);
  EXPECT_EQ(stop.machine.axis(0).velocity(), 75'000);  // 150 counts in 2 ms
  EXPECT_EQ(stop.verdict(1), AxisVerdict::stopped);
}

/// Two drives that a quick stop disables at once (605A = 0).
BusPlan coasting() {
  BusPlan plan = test::axes();
  for (NodePlan& node : plan.nodes) node.axes = {AxisPlan{.quick_stop_option = 0}};
  return plan;
}

TEST(OrderedStop, DoesNotConfirmADriveThatTheQuickStopDisablesWhileItMoves) {
  Stop stop{operation_enabled, coasting()};
  stop.speed = {150, 0};
  stop.step(10);
  stop.words = {switch_on_disabled, switch_on_disabled};
  stop.speed = {};
  stop.step(100);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::moving);
  EXPECT_EQ(stop.machine.axis(0).velocity(), 75'000);
  EXPECT_EQ(stop.verdict(1), AxisVerdict::unproven) << "positions over 18 ms show no standstill";
}

/// The first statusword of the stop shows that the quick stop has disabled the drive.
TEST(OrderedStop, RemembersTheVelocityFromBeforeTheQuickStop) {
  for (const std::int64_t velocity : {8000, 0}) {
    BusPlan plan = coasting();
    plan.layout.signals[2].object = ObjectKey{0x606C, 0};
    Stop stop{operation_enabled, plan};
    stop.place[0] = velocity;
    stop.step();
    stop.words[0] = switch_on_disabled;
    stop.place[0] = 0;
    stop.step(40);
    EXPECT_EQ(stop.verdict(0), velocity == 0 ? AxisVerdict::stopped : AxisVerdict::moving);
    EXPECT_EQ(stop.machine.axis(0).velocity(), velocity);
  }
}

TEST(OrderedStop, DoesNotTakeAnOldStatuswordForAnAnswer) {
  Stop stop;
  stop.values[0] = stop.values[1] = switch_on_disabled;  // from before the stop
  stop.every = {0, 0};
  stop.step(500);
  EXPECT_EQ(stop.machine.axis(0).state(), AxisState::unseen);
  EXPECT_EQ(stop.machine.result(), StopResult::under_way);
  EXPECT_EQ(stop.machine.controlword(0), 0x0002);
}

/// The frames come every 60 ms, and the axis moves 100 counts in 2 ms.
TEST(OrderedStop, DoesNotTakeARepeatedPositionForStandstill) {
  Stop stop;
  stop.every = {30, 30};
  stop.speed = {100, 100};
  for (int i = 0; i < 1500; ++i) {
    stop.step();
    ASSERT_EQ(stop.machine.controlword(0), 0x0002) << i;
  }
  stop.speed = {};
  stop.step(59);
  EXPECT_EQ(stop.machine.controlword(0), 0x0002) << "two frames at rest are too few";
  stop.step(1);
  EXPECT_EQ(stop.machine.controlword(0), 0x0000);
  stop.words = {switch_on_disabled, switch_on_disabled};
  stop.step(60);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

/// The first frame in the stop is lost. The drive coasts after the quick stop (605A = 0).
TEST(OrderedStop, DoesNotTakeItsOwnCommandForTheStateAtTheBeginning) {
  Stop stop;
  stop.speed = {150, 0};
  stop.every = {0, 0};
  stop.step(3);
  stop.every = {1, 1};
  stop.words = {switch_on_disabled, switch_on_disabled};
  stop.step(100);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::moving);
  EXPECT_EQ(stop.verdict(1), AxisVerdict::stopped) << "it was seen at standstill";
}

TEST(OrderedStop, NeedsAnSdoWhereNoFrameComes) {
  Stop stop;
  stop.step(10);
  EXPECT_FALSE(stop.machine.needs_word(0, stop.now));
  EXPECT_FALSE(stop.machine.needs_motion(0, stop.now));
  stop.every = {0, 1};
  stop.step(24);
  EXPECT_FALSE(stop.machine.needs_word(0, stop.now));
  stop.step(1);
  EXPECT_TRUE(stop.machine.needs_word(0, stop.now)) << "50 ms without a frame";
  EXPECT_TRUE(stop.machine.needs_motion(0, stop.now));
  EXPECT_FALSE(stop.machine.needs_word(1, stop.now));
  stop.stale[0] = 0b1010;
  stop.step(1);
  EXPECT_TRUE(stop.machine.needs_word(1, stop.now)) << "its TPDO is missing";
}

TEST(OrderedStop, NeedsAnSdoWhereFramesComeTooSlowly) {
  struct Rate {
    std::uint8_t transmission = 0;
    Time inhibit{};
    Time event_timer{};
  };
  for (const Rate slow : {Rate{.transmission = 26}, Rate{.transmission = 255, .inhibit = 100ms},
                          Rate{.transmission = 254, .event_timer = 200ms}}) {
    BusPlan plan = test::axes();
    plan.pdos.tpdos[0].transmission = slow.transmission;
    plan.pdos.tpdos[0].inhibit = slow.inhibit;
    plan.pdos.tpdos[0].event_timer = slow.event_timer;
    Stop stop{operation_enabled, plan};
    stop.step(10);
    EXPECT_TRUE(stop.machine.needs_word(0, stop.now)) << int{slow.transmission};
    EXPECT_TRUE(stop.machine.needs_motion(0, stop.now));
    EXPECT_FALSE(stop.machine.needs_word(1, stop.now));
  }
}

TEST(OrderedStop, TakesWhatAnSdoHasReadWhereNoPdoBringsIt) {
  Stop stop;
  stop.exchanging = {true, false};
  stop.words[0] = switch_on_disabled;
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

/// The node restarts while its axis brakes, and reports the velocity 0 when it is back.
TEST(OrderedStop, DoesNotConfirmADriveThatRestartsWhileItMoves) {
  Stop stop;
  stop.speed = {100, 0};
  stop.step(50);
  stop.nodes[0].bootups = 1;
  stop.speed[0] = 0;
  stop.words = {switch_on_disabled, switch_on_disabled};
  stop.step(100);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::moving);
  EXPECT_EQ(stop.machine.axis(0).velocity(), 50'000);
  EXPECT_EQ(stop.verdict(1), AxisVerdict::stopped);
  EXPECT_EQ(stop.machine.result(), StopResult::unconfirmed);
}

TEST(OrderedStop, DoesNotConfirmADriveThatRestartsBeforeItsFirstStatusword) {
  Stop stop;
  stop.every[0] = 0;
  stop.step(2);
  stop.nodes[0].bootups = 1;
  stop.words[0] = switch_on_disabled;
  stop.every[0] = 1;
  stop.step(100);
  EXPECT_EQ(stop.verdict(0), AxisVerdict::unproven);
}

TEST(OrderedStop, ConfirmsADriveThatRestartsAfterItWasSeenAtStandstill) {
  Stop stop;
  stop.words[0] = quick_stop_active;
  stop.step(100);
  stop.nodes[0].bootups = 1;
  stop.words = {switch_on_disabled, switch_on_disabled};
  stop.step(100);
  EXPECT_EQ(stop.machine.result(), StopResult::confirmed);
}

/// The boot has read 0x605A; the plan assumes that the drive brakes.
TEST(OrderedStop, BelievesTheDeviceThatItCoasts) {
  for (const auto& [what, verdict] : {std::pair{QuickStop::unread, AxisVerdict::stopped},
                                      {QuickStop::brakes, AxisVerdict::stopped},
                                      {QuickStop::coasts, AxisVerdict::moving}}) {
    Stop stop;
    std::array<AxisMemory, 2> memory;
    for (AxisMemory& axis : memory) axis.note_quick_stop(what);
    stop.machine.call_off();
    stop.machine.begin(stop.now, stop.nodes, OrderedStop::every_node, memory);
    stop.speed = {100, 0};
    stop.step(10);
    stop.speed[0] = 0;
    stop.words = {switch_on_disabled, switch_on_disabled};
    stop.step(100);
    EXPECT_EQ(stop.verdict(0), verdict);
  }
}

}  // namespace
}  // namespace takt::test
