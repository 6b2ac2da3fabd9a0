// Limits of the sum of a position target and the position offset 0x60B0.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/master/core/pdo/axis_with_modes.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;

/// An axis in cyclic position mode that follows target 0.
class FollowingAxis : public AxisWithModes {
 public:
  explicit FollowingAxis(const OutputLimit& limit) : AxisWithModes{limit} {
    feedback(0, enabled, 8);
    set(order_output, enable_operation);
    set(target_output, 0);
    set(mode_output, 8);
    set(offset_output, 0);
    cycle();
  }
};

TEST(OutputLimits, HoldTheSumOfTargetAndPositionOffsetInTheRange) {
  FollowingAxis axis{{.low = -100, .high = 100, .wraps = true}};
  axis.set(target_output, 60);
  axis.set(offset_output, 40);
  axis.cycle();
  EXPECT_EQ(axis.target(), 60);
  EXPECT_EQ(axis.offset(), 40);

  axis.set(offset_output, 41);
  axis.cycle();
  EXPECT_EQ(axis.offset(), 40);
  EXPECT_EQ(axis.controlword(), quick_stop);
  const auto reported = axis.refusals();
  ASSERT_EQ(reported.size(), 1U);
  EXPECT_THAT(reported[0], HasSubstr("command 0.041 rad to signal (60B0:00) is outside its limits: "
                                     "position 0.101, limit 0.1;"));

  axis.set(offset_output, 30);
  axis.set(target_output, 71);
  axis.cycle();
  EXPECT_EQ(axis.target(), 60);
  axis.set(order_output, enable_operation);
  axis.set(target_output, 70);
  axis.set(offset_output, 30);
  axis.cycle();
  axis.set(order_output, enable_operation);
  axis.set(target_output, 70);
  axis.set(offset_output, 30);
  axis.cycle();
  EXPECT_EQ(axis.target(), 70);
  EXPECT_EQ(axis.offset(), 30);
  EXPECT_EQ(axis.controlword(), enable_operation);
}

TEST(OutputLimits, MeasureStepsOfTheSumOfTargetAndPositionOffset) {
  FollowingAxis axis{{.step = 10, .wraps = true}};
  for (int i = 1; i <= 10; ++i) {
    axis.set(target_output, 4 * i);
    axis.set(offset_output, 6 * i);
    axis.cycle();
  }
  EXPECT_EQ(axis.target(), 40);
  EXPECT_EQ(axis.offset(), 60);
  axis.set(target_output, 46);
  axis.set(offset_output, 65);
  axis.cycle();
  EXPECT_EQ(axis.target(), 40);
  EXPECT_EQ(axis.offset(), 60);
  EXPECT_EQ(axis.refusals().size(), 1U);
}

TEST(OutputLimits, LetAnOffsetTurnAtConstantVelocityWithinTheAcceleration) {
  FollowingAxis axis{{.bend = 5, .wraps = true}};
  std::int64_t offset = 0;
  for (int speed = 0; speed <= 20; speed += 4) {
    axis.set(offset_output, offset += speed);
    axis.cycle();
  }
  for (int i = 0; i < 10; ++i) {
    axis.set(offset_output, offset += 20);
    axis.cycle();
  }
  EXPECT_EQ(axis.offset(), offset);
  EXPECT_TRUE(axis.refusals().empty());
  axis.set(offset_output, offset + 60);
  axis.cycle();
  EXPECT_EQ(axis.offset(), offset);
}

TEST(OutputLimits, HoldThePositionOffsetOfAControllerInTheRange) {
  FollowingAxis axis{{.low = -100, .high = 100, .wraps = true}};
  axis.write(target_output, 60);
  axis.write(offset_output, 40);
  axis.cycle();
  EXPECT_EQ(axis.offset(), 40);
  axis.write(offset_output, 41);
  axis.cycle();
  EXPECT_EQ(axis.offset(), 40);
  EXPECT_EQ(axis.controlword(), quick_stop);
  EXPECT_EQ(axis.refusals().size(), 1U);
}

TEST(LimitsAtEnabling, CountThePositionOffset) {
  FollowingAxis axis{{.step = 10, .wraps = true}};
  axis.feedback(0, disabled, 8);
  axis.set(order_output, 0x0006);
  axis.cycle();
  for (int i = 1; i <= 20; ++i) {
    axis.set(offset_output, 8 * i);
    axis.cycle();
  }
  EXPECT_EQ(axis.offset(), 8);
  EXPECT_EQ(axis.refusals().size(), 1U);
}

}  // namespace
}  // namespace takt::test
