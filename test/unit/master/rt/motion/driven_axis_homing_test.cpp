// What an axis does around its homing runs.
#include "test/unit/master/rt/motion/driven_axis_bench.hpp"

namespace takt {
namespace {

using motion::AxisState;
using test::Bench;

/// Homing changes the coordinates of the drive. A target that an application has commanded before
/// is then another position.
TEST(DrivenAxis, InHomingModeTheTargetFollowsWhoeverHasCommandedIt) {
  Bench bench{{.commands_controlword = true, .mode = true}};
  bench.hear(0x0027, 0);
  bench.command(1, 55);
  bench.pack();
  bench.hear(0x0027, 55);
  bench.condition();
  ASSERT_TRUE(bench.write(AxisState::standing, {.position = 0.55}));
  bench.command(3, 6);
  bench.pack();
  bench.hear(0x0027, 55);
  bench.condition();
  bench.last.actual.position = 9.0;
  ASSERT_TRUE(bench.write(AxisState::unpowered, {.position = 9.0}));
  EXPECT_EQ(bench.target(), 900);
}

TEST(DrivenAxis, SeesAHomingRunOfTheEnabledDriveInHomingMode) {
  using motion::HomingState;
  Bench bench{{.commands_controlword = true, .mode = true}};
  const auto after = [&](std::int64_t controlword, std::int64_t mode, std::uint16_t statusword) {
    bench.command(0, controlword);
    bench.command(3, mode);
    bench.pack();
    bench.hear(statusword, 0);
    return bench.axis.read(bench.pdos, true, bench.last).homing;
  };
  EXPECT_EQ(after(0x1F, 8, 0x0027), HomingState::none) << "in another mode";
  EXPECT_EQ(after(0x0F, 6, 0x0027), HomingState::none) << "bit 4 is not set";
  EXPECT_EQ(after(0x1F, 6, 0x0023), HomingState::none) << "not enabled";
  EXPECT_EQ(after(0x1F, 6, 0x0027), HomingState::runs);
  EXPECT_EQ(after(0x1F, 6, 0x1427), HomingState::homed);
  EXPECT_EQ(after(0x0F, 8, 0x1027), HomingState::homed);
  EXPECT_EQ(bench.axis.read(bench.pdos, false, bench.last).homing, HomingState::none);
}

/// The node was away only while there was no SYNC, so that it was present in each beat.
TEST(DrivenAxis, LosesItsHomeBetweenBeats) {
  using motion::HomingState;
  Bench bench{{.commands_controlword = true, .mode = true}};
  const auto homing = [&](std::uint16_t statusword) {
    bench.hear(statusword, 0);
    return bench.axis.read(bench.pdos, true, bench.last).homing;
  };
  bench.command(0, 0x1F);
  bench.command(3, 6);
  bench.pack();
  ASSERT_EQ(homing(0x0027), HomingState::runs);
  ASSERT_EQ(homing(0x1427), HomingState::homed);
  bench.command(0, 0x0F);
  bench.command(3, 8);
  bench.pack();
  ASSERT_EQ(homing(0x1027), HomingState::homed);
  bench.axis.lose_home();
  EXPECT_EQ(homing(0x1027), HomingState::none);
}

}  // namespace
}  // namespace takt
