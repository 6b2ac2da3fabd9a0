// Axes whose modes of operation are mapped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>
#include <takt/axis_control.hpp>

#include "test/unit/apps/axis/messages_for_tests.hpp"

namespace takt {
namespace {

using test::image;
using test::signal;
using test::two_axes;
using ::testing::ElementsAre;

constexpr std::int64_t enabled = 0x0237;

/// Axis 5, whose mode of operation and mode display replace the signals of axis 6.
class AxisWithModes : public ::testing::Test {
 protected:
  AxisWithModes() {
    layout_t layout = two_axes();
    layout.signals[1] = signal(5, 0x6061, false, 8);
    layout.signals[5] = signal(5, 0x6060, true, 8);
    layout.signals[7] = signal(5, 0x60FF, true, 32, 1e-3);
    input_.take(layout);
    axes_.set_layout(input_);
    axes_.set_goal(DriveGoal::enabled);
  }
  /// Returns the target position in counts after an image.
  std::int64_t target(std::int64_t shown_mode, std::int64_t position) {
    input_.take(image(++cycle_, {enabled, shown_mode, position, 0}));
    axes_.on_image(input_);
    return axes_.command().values.at(2);
  }
  std::int64_t target_velocity() { return axes_.command().values.at(3); }

  ImageInput input_;
  AxisControl axes_;
  std::int64_t cycle_ = 0;
};

TEST_F(AxisWithModes, DoesNotJumpBackWhenVelocityModeEnds) {
  axes_.set_mode(DriveMode::cyclic_velocity);
  EXPECT_EQ(target(9, 1000), 1000);
  axes_.set_velocities(Eigen::VectorXd::Constant(1, 0.5));
  EXPECT_EQ(target(9, 3000), 3000);
  EXPECT_EQ(target_velocity(), 500);

  axes_.set_mode(DriveMode::cyclic_position);
  EXPECT_EQ(target(9, 3100), 3100) << "the drive is not in its new mode yet";
  EXPECT_EQ(target(8, 3150), 3100);
  EXPECT_EQ(target(8, 3160), 3100);
}

TEST_F(AxisWithModes, StopsWhereTheVelocityIsNoNumber) {
  axes_.set_mode(DriveMode::cyclic_velocity);
  target(9, 1000);
  axes_.set_velocities(Eigen::VectorXd::Constant(1, 0.5));
  axes_.set_velocities(Eigen::VectorXd::Constant(1, -std::numeric_limits<double>::infinity()));
  EXPECT_EQ(target_velocity(), 0);
}

TEST_F(AxisWithModes, TakesNoTargetPositionOutsideOfThePositionModes) {
  target(8, 1000);
  axes_.set_positions(Eigen::VectorXd::Constant(1, 2.0));
  EXPECT_EQ(target(8, 1000), 2000);
  EXPECT_EQ(target(6, 1200), 1200) << "homing";
  axes_.set_positions(Eigen::VectorXd::Constant(1, 2.0));
  EXPECT_EQ(axes_.command().values.at(2), 1200);
}

TEST_F(AxisWithModes, TakesTargetPositionsInProfilePosition) {
  axes_.set_mode(DriveMode::profile_position);
  target(1, 1000);
  axes_.set_positions(Eigen::VectorXd::Constant(1, 2.0));
  EXPECT_EQ(target(1, 1100), 2000);
}

TEST(AxisControl, KeepsAVelocityWhereNoPositionIsMapped) {
  layout_t layout = two_axes();
  layout.signals[1] = signal(5, 0x6061, false, 8);
  layout.signals[2] = signal(5, 0x606C, false, 32, 1e-3);
  layout.signals[5] = signal(5, 0x6060, true, 8);
  layout.signals[6] = signal(5, 0x60FF, true, 32, 1e-3);
  ImageInput input;
  input.take(layout);
  AxisControl axes;
  axes.set_layout(input);
  axes.set_mode(DriveMode::cyclic_velocity);
  axes.set_goal(DriveGoal::enabled);
  const auto see = [&](std::int64_t cycle) {
    input.take(image(cycle, {enabled, 9, 0, 0}));
    axes.on_image(input);
    return axes.command().values;
  };
  see(1);
  axes.set_velocities(Eigen::VectorXd::Constant(1, 0.5));

  EXPECT_THAT(see(2), ::testing::Contains(500));
  EXPECT_THAT(see(3), ::testing::Contains(500));
}

TEST_F(AxisWithModes, KeepsTheModeInANewLayoutOnlyIfItIsThatOfAllAxes) {
  axes_.set_mode(DriveMode::cyclic_velocity);
  axes_.set_mode(0, DriveMode::homing);
  target(6, 0);
  EXPECT_TRUE(axes_.in_mode(0));
  axes_.set_layout(input_);
  target(9, 0);
  EXPECT_TRUE(axes_.in_mode(0));
}

TEST(AxisControl, CommandsTheModeWhereItIsMapped) {
  layout_t layout = two_axes();
  layout.signals[1] = signal(5, 0x6061, false, 8);
  layout.signals[5] = signal(5, 0x6060, true, 8);
  ImageInput input;
  input.take(layout);
  AxisControl axes;
  axes.set_layout(input);
  axes.set_mode(DriveMode::cyclic_position);
  input.take(image(1, {enabled, 1, 0, 0}));
  axes.on_image(input);

  EXPECT_FALSE(axes.in_mode());
  EXPECT_THAT(axes.command().values, ElementsAre(0x0007, 8, 0));
  input.take(image(2, {enabled, 8, 0, 0}));
  axes.on_image(input);
  EXPECT_TRUE(axes.in_mode());
}

TEST(AxisControl, IsInNoModeWhereTheModeIsNeitherMappedNorShown) {
  ImageInput input;
  input.take(two_axes());
  AxisControl axes;
  axes.set_layout(input);
  axes.set_mode(DriveMode::cyclic_position);
  input.take(image(1, {enabled, 1, 0, 0}));
  axes.on_image(input);

  EXPECT_FALSE(axes.in_mode());
}

TEST(AxisControl, IsInTheModeThatItCommandsWhereNoneIsShown) {
  layout_t layout = two_axes();
  layout.signals[1] = signal(5, 0x606C, false, 32);
  layout.signals[5] = signal(5, 0x6060, true, 8);
  ImageInput input;
  input.take(layout);
  AxisControl axes;
  axes.set_layout(input);

  EXPECT_TRUE(axes.in_mode());
}

}  // namespace
}  // namespace takt
