// What an axis reads from its drive, and what it writes.
#include "test/unit/master/rt/motion/driven_axis_bench.hpp"

namespace takt {
namespace {

using motion::AxisCondition;
using motion::AxisState;
using test::Bench;
using test::one_axis;

TEST(DrivenAxis, ReadsTheConditionFromTheStatusword) {
  Bench bench;
  bench.hear(0x0027, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::enabled);
  bench.hear(0x0023, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::disabled);
  bench.hear(0x0007, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::disabled) << "quick stop active";
  bench.hear(0x0008, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::fault);
  bench.hear(0x000F, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::fault) << "fault reaction active";
  EXPECT_EQ(bench.condition(false), AxisCondition::lost);
}

TEST(DrivenAxis, OneMissingFrameIsNoSilenceButThreeAre) {
  Bench bench;
  bench.hear(0x0027, 100);
  bench.last.commanded.position = 1.5;
  bench.last.following_error = 0.5;
  EXPECT_EQ(bench.condition(), AxisCondition::enabled);
  bench.hear_nothing();
  const motion::AxisInput input = bench.axis.read(bench.pdos, true, bench.last);
  EXPECT_EQ(input.condition, AxisCondition::enabled);
  EXPECT_EQ(input.actual.position, 1.0) << "the following error counts as unchanged";
  bench.hear_nothing();
  EXPECT_EQ(bench.condition(), AxisCondition::enabled);
  bench.hear_nothing();
  EXPECT_EQ(bench.condition(), AxisCondition::silent);
  bench.hear(0x0027, 100);
  EXPECT_EQ(bench.condition(), AxisCondition::enabled);
}

TEST(DrivenAxis, AHaltIsNoLossOfOperationEnabled) {
  Bench bench;
  bench.command(0, 0x010F);
  bench.pack();
  bench.hear(0x0027, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::halted);
  bench.hear(0x0008, 0);
  EXPECT_EQ(bench.condition(), AxisCondition::fault);
}

TEST(DrivenAxis, WritesPositionAndVelocityInCounts) {
  Bench bench;
  bench.hear(0x0027, 0);
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = -1.236, .velocity = 0.74}));
  EXPECT_EQ(bench.target(), -124);
  EXPECT_EQ(bench.offset(), 7);
  EXPECT_FALSE(bench.axis.read(bench.pdos, true, bench.last).set_point.has_value());
  ASSERT_TRUE(bench.write(AxisState::standing, {.position = -1.25}));
  EXPECT_EQ(bench.target(), -125);
  EXPECT_EQ(bench.offset(), 0);
}

TEST(DrivenAxis, APositionThatInteger32CannotHoldIsNotWritten) {
  Bench bench;
  bench.hear(0x0027, 0);
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.0}));
  EXPECT_FALSE(bench.write(AxisState::moving, {.position = 3e7}));
  EXPECT_EQ(bench.target(), 100);
}

/// A position in one unit must not be written in another one.
TEST(DrivenAxis, AnAxisWhoseTargetHasAnotherUnitThanItsPositionHasNoMotions) {
  const auto axes_after = [](auto change) {
    BusPlan plan = one_axis();
    change(plan.layout.signals[3]);
    return motion_axes(plan).size();
  };
  EXPECT_EQ(axes_after([](Signal&) {}), 1U);
  EXPECT_EQ(axes_after([](Signal& target) { target.scale = 0.02; }), 0U);
  EXPECT_EQ(axes_after([](Signal& target) { target.offset = 1.0; }), 0U);
  EXPECT_EQ(axes_after([](Signal& target) { target.unit = "m"; }), 0U);
}

}  // namespace
}  // namespace takt
