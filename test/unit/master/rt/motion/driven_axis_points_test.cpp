// An axis in interpolated position mode, whose drive says when the mode is active.
#include "test/unit/master/rt/motion/driven_axis_bench.hpp"

namespace takt {
namespace {

using motion::AxisCondition;
using test::Bench;

BusPlan one_axis_with_points() {
  BusPlan plan = test::one_axis(true);
  for (Signal& signal : plan.layout.signals) {
    if (signal.object.index == 0x607A) signal.object = {0x60C1, 1};
  }
  return plan;
}

class Points : public testing::Test {
 protected:
  AxisCondition after(std::int64_t controlword, std::int64_t mode, std::uint16_t statusword) {
    bench_.command(0, controlword);
    bench_.command(3, mode);
    bench_.pack();
    bench_.hear(statusword, 0);
    return bench_.condition();
  }

  Bench bench_{one_axis_with_points()};
};

TEST_F(Points, TheAxisFollowsWhereBit4OfItsControlwordIsSetInMode7) {
  EXPECT_EQ(after(0x0F, 7, 0x0027), AxisCondition::inactive);
  EXPECT_EQ(after(0x1F, 8, 0x0027), AxisCondition::disabled);
  EXPECT_EQ(after(0x1F, 7, 0x0027), AxisCondition::enabled) << "bit 12 was never set";
}

TEST_F(Points, BitTwelveOfTheStatuswordEndsIt) {
  EXPECT_EQ(after(0x1F, 7, 0x1027), AxisCondition::enabled);
  EXPECT_EQ(after(0x1F, 7, 0x0027), AxisCondition::inactive);
  EXPECT_EQ(after(0x1F, 7, 0x1027), AxisCondition::enabled);
}

/// Otherwise the drive would go back to the old target when the mode becomes active again.
TEST_F(Points, WhileTheModeIsNotActiveTheTargetFollowsTheActualPosition) {
  ASSERT_EQ(after(0x1F, 7, 0x1027), AxisCondition::enabled);
  ASSERT_EQ(after(0x1F, 7, 0x0027), AxisCondition::inactive);
  bench_.last.actual.position = 2.5;
  ASSERT_TRUE(bench_.write(motion::AxisState::unpowered, {.position = 0.0}));
  EXPECT_EQ(bench_.target(), 250);
}

}  // namespace
}  // namespace takt
