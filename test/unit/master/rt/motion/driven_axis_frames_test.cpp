// Whether the set-points of an axis reach the bus.
#include "test/unit/master/rt/motion/driven_axis_bench.hpp"

namespace takt {
namespace {

using motion::AxisCondition;
using motion::AxisState;
using test::Bench;

/// Otherwise the set-points of a motion would be held back, and then be sent as one step.
TEST(DrivenAxis, AnAxisWhoseRpdoIsNotReadyIsNotEnabled) {
  Bench bench{{.commands_controlword = false, .mode = false}};
  bench.hear(0x0027, 100);
  EXPECT_EQ(bench.condition(), AxisCondition::disabled);
  bench.command(0, 0x000F);
  bench.pack();
  bench.hear(0x0027, 100);
  EXPECT_EQ(bench.condition(), AxisCondition::enabled);
}

/// The master does not send an event-driven RPDO while its set-points do not change.
TEST(DrivenAxis, ATargetThatDoesNotChangeNeedsNoFrame) {
  Bench bench;
  bench.hear(0x0027, 0);
  bench.condition();
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.0}));
  bench.pack();
  bench.hear(0x0027, 0);
  bench.condition();
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 1.0}));
  bench.command(1, 120);
  bench.pack();
  for (int beat = 0; beat < 5; ++beat) {
    bench.hear(0x0027, 0);
    EXPECT_EQ(bench.condition(), AxisCondition::enabled) << beat;
    ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.2}));
  }
}

TEST(DrivenAxis, ASetPointThatWasDueAndNotSentIsTold) {
  Bench bench;
  const auto is_unsent = [&](double position, bool sends) {
    bench.hear(0x0027, 0);
    const bool found = bench.axis.read(bench.pdos, true, bench.last).is_unsent;
    EXPECT_TRUE(bench.write(AxisState::moving, {.position = position}));
    bench.pack(sends);
    return found;
  };
  EXPECT_FALSE(is_unsent(0.1, true));
  EXPECT_FALSE(is_unsent(0.2, false));
  EXPECT_TRUE(is_unsent(0.2, true));
  EXPECT_FALSE(is_unsent(0.3, true));
}

/// The velocity of the axis rises by two counts a cycle in each cycle, as its limit allows.
BusPlan limited_axis() {
  BusPlan plan = test::one_axis();
  plan.limits.outputs.push_back({.signal = 3,
                                 .bend = 2,
                                 .quantity = AxisQuantity::position,
                                 .controlword = SignalIndex{2},
                                 .feedback = SignalIndex{1},
                                 .statusword = SignalIndex{0}});
  return plan;
}

TEST(DrivenAxis, TheDelayOfAMotionIsNoAccelerationForTheLimits) {
  Bench bench{limited_axis()};
  const auto beat = [&](double counts, bool sends, motion::CycleNumber delay = 0) {
    bench.hear(0x0027, static_cast<std::int32_t>(bench.target()));
    bench.condition();
    bench.last.delay = delay;
    const bool taken = bench.write(AxisState::moving, {.position = counts * 0.01});
    bench.pack(sends);
    return taken;
  };
  for (const int counts : {0, 2, 6, 12, 20, 30}) ASSERT_TRUE(beat(counts, true)) << counts;
  EXPECT_TRUE(beat(42, false));
  EXPECT_TRUE(beat(42, true, 1)) << "the same set-point again";
  EXPECT_TRUE(beat(56, true));
  EXPECT_FALSE(beat(76, true)) << "six counts more than in the cycle before";
}

TEST(DrivenAxis, OneSetPointMayWaitForItsFrameButNotTwo) {
  Bench bench;
  const auto beat = [&](double position, bool sends) {
    bench.hear(0x0027, 0);
    const AxisCondition found = bench.condition();
    EXPECT_TRUE(bench.write(AxisState::moving, {.position = position}));
    bench.pack(sends);
    return found;
  };
  EXPECT_EQ(beat(0.1, true), AxisCondition::enabled);
  EXPECT_EQ(beat(0.2, false), AxisCondition::enabled);
  EXPECT_EQ(beat(0.3, true), AxisCondition::enabled) << "one frame was not sent";
  EXPECT_EQ(beat(0.4, false), AxisCondition::enabled);
  EXPECT_EQ(beat(0.5, false), AxisCondition::enabled);
  EXPECT_EQ(beat(0.6, true), AxisCondition::unsent) << "two frames were not sent";
  EXPECT_EQ(beat(0.7, true), AxisCondition::enabled);
}

}  // namespace
}  // namespace takt
