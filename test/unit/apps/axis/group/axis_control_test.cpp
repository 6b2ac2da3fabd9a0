#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <takt/axis_control.hpp>

#include "test/unit/apps/axis/messages_for_tests.hpp"

namespace takt {
namespace {

using test::image;
using test::signal;
using test::two_axes;
using ::testing::ElementsAre;

constexpr std::int64_t not_commanded = -1;
constexpr std::int64_t disabled = 0x0250;
constexpr std::int64_t ready = 0x0231;
constexpr std::int64_t enabled = 0x0237;
constexpr std::int64_t fault = 0x0218;

/// Positions of signals in the layout of two_axes().
constexpr std::int32_t position_5 = 2;
constexpr std::int32_t controlword_5 = 4;
constexpr std::int32_t controlword_6 = 5;
constexpr std::int32_t target_5 = 6;
constexpr std::int32_t target_6 = 7;

class TwoAxes : public ::testing::Test {
 protected:
  TwoAxes() {
    input_.take(two_axes());
    axes_.set_layout(input_);
  }
  void see(std::initializer_list<std::int64_t> values) {
    input_.take(image(++cycle_, values));
    axes_.on_image(input_);
  }
  void see_stale(std::initializer_list<std::int64_t> values, std::int32_t stale) {
    image_t missing = image(++cycle_, values);
    missing.stale = {stale};
    missing.num_stale = 1;
    input_.take(missing);
    axes_.on_image(input_);
  }
  std::int64_t commanded(std::int32_t signal) {
    const command_t& command = axes_.command();
    for (std::size_t i = 0; i < command.signals.size(); ++i) {
      if (command.signals[i] == signal) return command.values[i];
    }
    return not_commanded;
  }

  ImageInput input_;
  AxisControl axes_;
  std::int64_t cycle_ = 0;
};

TEST_F(TwoAxes, AreFoundByNode) {
  ASSERT_EQ(axes_.size(), 2);
  EXPECT_EQ(axes_.name(0), "shoulder");
  EXPECT_EQ(axes_.name(1), "elbow");
}

TEST_F(TwoAxes, HavePositionsInSi) {
  see({disabled, disabled, 1500, -250});
  EXPECT_DOUBLE_EQ(axes_.positions()(0), 1.5);
  EXPECT_DOUBLE_EQ(axes_.positions()(1), -0.25);
}

TEST_F(TwoAxes, AreCommandedWithTheSessionAndCycleOfTheirImage) {
  cycle_ = 41;
  see({disabled, disabled, 0, 0});
  const command_t& command = axes_.command();
  EXPECT_EQ(command.session, 77);
  EXPECT_EQ(command.cycle, 42);
  EXPECT_EQ(command.schema, 2);
  EXPECT_THAT(command.signals, ElementsAre(controlword_5, target_5, controlword_6, target_6));
  EXPECT_EQ(command.num_values, 4);
}

TEST_F(TwoAxes, DoNotJumpWhenTheyAreEnabled) {
  axes_.set_goal(DriveGoal::enabled);
  see({ready, ready, 1500, -250});
  EXPECT_EQ(commanded(target_5), 1500);
  axes_.set_positions(Eigen::Vector2d{9.0, 9.0});
  EXPECT_EQ(commanded(target_5), 1500);
  see({enabled, ready, 1502, -250});
  EXPECT_EQ(commanded(target_5), 1500);
  EXPECT_EQ(commanded(target_6), -250);
}

TEST_F(TwoAxes, StayWhereTheyAreWhenTheyAreFoundEnabled) {
  axes_.set_goal(DriveGoal::enabled);
  see({enabled, enabled, 1500, -250});
  EXPECT_EQ(commanded(target_5), 1500);
  EXPECT_EQ(commanded(target_6), -250);
  see({enabled, enabled, 1503, -250});
  EXPECT_EQ(commanded(target_5), 1500);
}

TEST_F(TwoAxes, KeepTheTargetThatIsSentWhenTheyAreFoundEnabled) {
  axes_.set_goal(DriveGoal::enabled);
  see({enabled, ready, 1500, -250, 0x000F, 0x0007, 1512, -999});
  EXPECT_EQ(commanded(target_5), 1512);
  EXPECT_EQ(commanded(target_6), -250);
}

TEST_F(TwoAxes, StayWhereTheyAreWhenANewLayoutFindsThemEnabled) {
  axes_.set_goal(DriveGoal::enabled);
  see({enabled, enabled, 0, 0});
  axes_.set_positions(Eigen::Vector2d{2.0, 2.0});
  axes_.set_layout(input_);
  see({enabled, enabled, 700, 100});
  EXPECT_EQ(commanded(target_5), 700);
  EXPECT_EQ(commanded(target_6), 100);
}

TEST_F(TwoAxes, AreNotEnabledBeforeTheirPositionWasSeen) {
  axes_.set_goal(DriveGoal::enabled);
  see_stale({ready, ready, 0, -250}, position_5);
  EXPECT_EQ(commanded(controlword_5), 0x0000);
  EXPECT_EQ(commanded(target_5), not_commanded);
  EXPECT_EQ(commanded(controlword_6), 0x0007);
  EXPECT_EQ(commanded(target_6), -250);

  see({ready, ready, 1500, -250});
  EXPECT_EQ(commanded(controlword_5), 0x0007);
  EXPECT_EQ(commanded(target_5), 1500);
  see_stale({ready, ready, 1500, -250}, position_5);
  EXPECT_EQ(commanded(controlword_5), 0x0007) << "once is enough";
}

TEST_F(TwoAxes, StayEnabledWithoutATargetUntilTheirPositionIsSeen) {
  axes_.set_goal(DriveGoal::enabled);
  see_stale({enabled, enabled, 0, 0}, position_5);
  axes_.set_positions(Eigen::Vector2d{2.0, 2.0});
  EXPECT_EQ(commanded(controlword_5), 0x000F);
  EXPECT_EQ(commanded(target_5), not_commanded);
  see({enabled, enabled, 1500, 0});
  EXPECT_EQ(commanded(target_5), 1500);
}

TEST_F(TwoAxes, TakeTargetsOnlyWhereTheyAreEnabled) {
  axes_.set_goal(DriveGoal::enabled);
  see({enabled, ready, 1500, -250});
  axes_.set_positions(Eigen::Vector2d{2.0, 2.0});
  EXPECT_EQ(commanded(target_5), 2000);
  EXPECT_EQ(commanded(target_6), -250);
}

TEST_F(TwoAxes, KeepTheirTargetsWhereThePositionIsNoNumber) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  axes_.set_goal(DriveGoal::enabled);
  see({enabled, enabled, 1500, -250});
  axes_.set_positions(Eigen::Vector2d{nan, 1.0});
  EXPECT_EQ(commanded(target_5), 1500);
  EXPECT_EQ(commanded(target_6), 1000);
  axes_.set_positions(Eigen::Vector2d{infinity, -infinity});
  EXPECT_EQ(commanded(target_5), 1500);
  EXPECT_EQ(commanded(target_6), 1000);
}

TEST_F(TwoAxes, FollowTheirPositionAgainAfterAFault) {
  axes_.set_goal(DriveGoal::enabled);
  see({enabled, enabled, 0, 0});
  axes_.set_positions(Eigen::Vector2d{2.0, 2.0});
  see({fault, enabled, 700, 100});
  EXPECT_EQ(commanded(target_5), 700);
  EXPECT_EQ(commanded(target_6), 2000);
  EXPECT_EQ(commanded(controlword_5), 0x0000);
  EXPECT_EQ(commanded(controlword_6), 0x000F);
  EXPECT_FALSE(axes_.all_enabled());
}

TEST_F(TwoAxes, HoldTheControlwordWhileTheStatuswordIsMissing) {
  axes_.set_goal(DriveGoal::enabled);
  see({ready, ready, 0, 0});
  EXPECT_EQ(commanded(controlword_5), 0x0007);
  see_stale({fault, ready, 0, 0}, 0);
  EXPECT_EQ(commanded(controlword_5), 0x0007);
  EXPECT_TRUE(axes_.stale(0));
  EXPECT_FALSE(axes_.stale(1));
}

TEST_F(TwoAxes, AreRaisedAndLoweredByTheHandshakeInProfilePosition) {
  axes_.set_mode(DriveMode::profile_position);
  axes_.set_goal(DriveGoal::enabled);
  see({enabled, enabled, 0, 0});
  EXPECT_EQ(commanded(controlword_5), 0x002F);
  axes_.begin_set_points();
  see({enabled, enabled, 0, 0});
  EXPECT_EQ(commanded(controlword_5), 0x003F);
  see({0x1237, enabled, 0, 0});
  EXPECT_EQ(commanded(controlword_5), 0x002F);
  EXPECT_EQ(commanded(controlword_6), 0x003F);
}

TEST_F(TwoAxes, AreHomedByBit4OneByOne) {
  axes_.set_goal(DriveGoal::enabled);
  see({enabled, enabled, 0, 0});
  axes_.start_homing(0);
  see({enabled, enabled, 0, 0});
  EXPECT_EQ(commanded(controlword_5), 0x000F) << "it is in another mode";

  axes_.set_mode(0, DriveMode::homing);
  axes_.start_homing(0);
  see({enabled, enabled, 0, 0});
  EXPECT_EQ(commanded(controlword_5), 0x001F);
  EXPECT_EQ(commanded(controlword_6), 0x000F);
  axes_.end_homing(0);
  see({enabled, enabled, 0, 0});
  EXPECT_EQ(commanded(controlword_5), 0x000F);

  axes_.start_homing(0);
  axes_.set_mode(0, DriveMode::cyclic_position);
  see({enabled, enabled, 0, 0});
  EXPECT_EQ(commanded(controlword_5), 0x000F);
}

TEST_F(TwoAxes, DoNotGoOnHomingAfterAFault) {
  axes_.set_goal(DriveGoal::enabled);
  see({enabled, enabled, 0, 0});
  axes_.set_mode(DriveMode::homing);
  axes_.start_homing(0);
  see({fault, enabled, 0, 0});
  axes_.set_goal(0, DriveGoal::enabled);
  see({enabled, enabled, 0, 0});
  EXPECT_EQ(commanded(controlword_5), 0x000F);
}

TEST_F(TwoAxes, HaveNoHandshakeOutsideProfilePosition) {
  axes_.set_goal(DriveGoal::enabled);
  see({enabled, enabled, 0, 0});
  axes_.begin_set_points();
  EXPECT_TRUE(axes_.set_points_taken()) << "nothing would ever acknowledge it";

  axes_.set_mode(DriveMode::profile_position);
  axes_.begin_set_points();
  see({enabled, enabled, 0, 0});
  EXPECT_FALSE(axes_.set_points_taken());
  axes_.set_mode(DriveMode::cyclic_position);
  EXPECT_TRUE(axes_.set_points_taken());
  see({enabled, enabled, 0, 0});
  EXPECT_EQ(commanded(controlword_5), 0x000F);
}

TEST_F(TwoAxes, ShowsTargetsInTheCountsThatTheImageWillShow) {
  axes_.set_goal(DriveGoal::enabled);
  see({enabled, enabled, 0, 0});
  axes_.set_positions(Eigen::Vector2d{0.12345678, -0.5});
  const Eigen::VectorXd shown = axes_.target_positions_in_counts();
  EXPECT_NE(shown, axes_.target_positions());

  see({enabled, enabled, 0, 0, 0x0F, 0x0F, commanded(target_5), commanded(target_6)});
  EXPECT_EQ(axes_.sent_positions(), shown);
}

TEST_F(TwoAxes, ShallBeDisabledAfterANewLayout) {
  axes_.set_goal(DriveGoal::enabled);
  see({enabled, enabled, 0, 0});
  layout_t again = two_axes();
  again.session = 78;
  input_.take(again);
  axes_.set_layout(input_);
  EXPECT_EQ(axes_.drive(0).goal(), DriveGoal::disabled);
}

TEST(AxisControl, HasNoTargetWithoutAPositionBeforeItIsGivenOne) {
  layout_t layout = two_axes();
  layout.signals[2] = signal(5, 0x606C, false, 32);
  ImageInput input;
  input.take(layout);
  AxisControl axes;
  axes.set_layout(input);
  axes.set_goal(DriveGoal::enabled);
  input.take(image(1, {ready, ready, 0, 0}));
  axes.on_image(input);
  EXPECT_THAT(axes.command().signals, ElementsAre(controlword_5, controlword_6, target_6));
  EXPECT_THAT(axes.command().values, ElementsAre(0x0007, 0x0007, 0));

  axes.set_positions(Eigen::Vector2d{2.0, 2.0});
  EXPECT_THAT(axes.command().values, ElementsAre(0x0007, 2000, 0x0007, 0));
  input.take(image(2, {ready, ready, 0, 0}));
  axes.on_image(input);
  EXPECT_THAT(axes.command().values, ElementsAre(0x0007, 2000, 0x0007, 0));
}

}  // namespace
}  // namespace takt
