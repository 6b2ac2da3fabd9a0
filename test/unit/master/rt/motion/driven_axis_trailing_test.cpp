// When the target position follows the actual position.
#include "test/unit/master/rt/motion/driven_axis_bench.hpp"

namespace takt {
namespace {

using motion::AxisCondition;
using motion::AxisState;
using test::Bench;

/// Bit 12 of the statusword is 1 while the drive follows its target position.
TEST(DrivenAxis, TheTargetFollowsTheActualPositionWhileADriveObeysAHalt) {
  Bench bench;
  const auto beat = [&](std::uint16_t statusword, std::int32_t position, AxisState state) {
    bench.hear(statusword, position);
    const motion::AxisInput input = bench.axis.read(bench.pdos, true, bench.last);
    if (input.set_point) bench.last.commanded.position = *input.set_point;
    EXPECT_TRUE(bench.write(state, bench.last.commanded));
    bench.pack();
  };
  bench.hear(0x1027, 100);
  bench.condition();
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.0}));
  bench.pack();
  bench.command(0, 0x010F);
  beat(0x1027, 100, AxisState::standing);
  beat(0x1027, 90, AxisState::standing);
  EXPECT_EQ(bench.target(), 100) << "it follows its target in spite of the Halt";
  beat(0x0027, 80, AxisState::standing);
  EXPECT_EQ(bench.target(), 80);
  beat(0x0027, 75, AxisState::standing);
  EXPECT_EQ(bench.target(), 75);
  bench.command(0, 0x000F);
  beat(0x0027, 75, AxisState::standing);
  beat(0x0027, 74, AxisState::standing);
  EXPECT_EQ(bench.target(), 75) << "the Halt has ended";
  beat(0x1027, 74, AxisState::standing);
  EXPECT_EQ(bench.target(), 75);
}

/// A drive whose TPDOs do not arrive may still follow its target position.
TEST(DrivenAxis, TheTargetFollowsTheActualPositionOnlyWhileTheStatuswordSaysThatItHasNoEffect) {
  Bench bench;
  bench.hear(0x0027, 100);
  bench.condition();
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.2}));
  const auto hold = [&](bool exchanging) {
    bench.condition(exchanging);
    bench.last.actual.position = 1.0;
    return bench.write(AxisState::unpowered, {.position = 1.0});
  };
  bench.hear(0x0027, 100);
  ASSERT_TRUE(hold(false));
  EXPECT_EQ(bench.target(), 120) << "the node is lost";
  bench.hear_nothing();
  ASSERT_TRUE(hold(true));
  EXPECT_EQ(bench.target(), 120) << "the statusword is missing";
  bench.hear(0x0023, 100);
  ASSERT_TRUE(hold(true));
  EXPECT_EQ(bench.target(), 100);
}

/// The second set-point of the motion can't be written.
TEST(DrivenAxis, AfterARefusedSetPointTheVelocityIsZeroAndTheTargetFollowsADriveThatIsNotEnabled) {
  Bench bench;
  bench.hear(0x0027, 0);
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.0, .velocity = 0.7}));
  ASSERT_EQ(bench.offset(), 7);
  EXPECT_FALSE(bench.write(AxisState::moving, {.position = 3e7, .velocity = 0.7}));
  EXPECT_EQ(bench.target(), 100);
  EXPECT_EQ(bench.offset(), 0);
  bench.hear(0x0027, 90);
  const motion::AxisInput input = bench.axis.read(bench.pdos, true, bench.last);
  ASSERT_TRUE(input.set_point.has_value());
  EXPECT_EQ(*input.set_point, 1.0) << "where the motion has led the axis";
  bench.hear(0x0023, 95);
  bench.last.actual = bench.axis.read(bench.pdos, true, bench.last).actual;
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 0.95}));
  EXPECT_EQ(bench.target(), 95);
}

TEST(DrivenAxis, AMotionWhoseFirstSetPointIsRefusedLeavesTheOutputsToOthers) {
  Bench bench;
  bench.hear(0x0023, 40);
  bench.command(1, 55);
  bench.command(2, 3);
  bench.pack();
  bench.condition();
  EXPECT_FALSE(bench.write(AxisState::moving, {.position = 3e7, .velocity = 0.7}));
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 0.4}));
  EXPECT_EQ(bench.target(), 55);
  EXPECT_EQ(bench.offset(), 3);
}

TEST(DrivenAxis, TheTargetFollowsTheActualPositionWhileTheDriveIsNotEnabled) {
  Bench bench;
  bench.hear(0x0027, 100);
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.0}));
  bench.hear(0x0008, 130);
  bench.last.actual = bench.axis.read(bench.pdos, true, bench.last).actual;
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 1.3}));
  EXPECT_EQ(bench.target(), 130);
}

TEST(DrivenAxis, ASetPointOfAnApplicationIsReadAndNotOverwritten) {
  Bench bench;
  bench.hear(0x0027, 0);
  bench.command(1, 55);
  bench.pack();
  const auto input = bench.axis.read(bench.pdos, true, bench.last);
  ASSERT_TRUE(input.set_point.has_value());
  EXPECT_DOUBLE_EQ(*input.set_point, 0.55);
  ASSERT_TRUE(bench.write(AxisState::standing, {.position = 0.55}));
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 0.0}));
  EXPECT_EQ(bench.target(), 55);
}

/// Modes 7, interpolated position, and 3, profile velocity.
TEST(DrivenAxis, TheTargetDoesNotFollowTheActualPositionInAModeInWhichTheDriveMayFollowIt) {
  Bench bench{{.commands_controlword = true, .mode = true}};
  bench.hear(0x0027, 100);
  ASSERT_EQ(bench.condition(), AxisCondition::enabled);
  ASSERT_TRUE(bench.write(AxisState::moving, {.position = 1.2}));
  const auto after_mode = [&](std::int64_t mode) {
    bench.command(3, mode);
    bench.pack();
    bench.hear(0x0027, 100);
    EXPECT_EQ(bench.condition(), AxisCondition::disabled) << mode;
    bench.last.actual.position = 1.0;
    EXPECT_TRUE(bench.write(AxisState::unpowered, {.position = 1.0}));
    return bench.target();
  };
  EXPECT_EQ(after_mode(7), 120);
  EXPECT_EQ(after_mode(-1), 120) << "a mode of the manufacturer";
  EXPECT_EQ(after_mode(3), 100);
}

/// The application enables the drive by its controlword only, and the axis was pushed.
TEST(DrivenAxis, ATargetThatNobodyHasCommandedFollowsTheActualPositionWhileTheDriveIsNotEnabled) {
  Bench bench;
  bench.hear(0x0023, 1000);
  bench.last.actual = bench.axis.read(bench.pdos, true, bench.last).actual;
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 10.0}));
  EXPECT_EQ(bench.target(), 1000);
  bench.pack();
  bench.hear(0x0027, 1100);
  bench.condition();
  ASSERT_TRUE(bench.write(AxisState::standing, {.position = 10.0}));
  EXPECT_EQ(bench.target(), 1000) << "it is enabled";
}

}  // namespace
}  // namespace takt
