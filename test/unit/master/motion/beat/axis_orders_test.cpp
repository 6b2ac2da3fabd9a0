#include <array>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "test/unit/master/motion/beat/plant.hpp"

namespace takt::motion {
namespace {

using test::Plant;

TEST(AxisOrders, AnOrderBeginsInItsBeatAndEndsAtItsTarget) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 0.02})));
  plant.steps(9);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  plant.step();
  EXPECT_EQ(plant.last[0].state, AxisState::moving);
  EXPECT_EQ(plant.last[0].commanded.position, 0.0);
  EXPECT_EQ(plant.last[0].running, 1U);
  const CycleNumber left = plant.last[0].cycles_left;
  plant.steps(static_cast<int>(left));
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::done);
  EXPECT_NEAR(plant.last[0].commanded.position, 0.02, 1e-12);
}

TEST(AxisOrders, AnAxisThatIsNotEnabledFollowsItsActualPosition) {
  Plant plant{1};
  plant.follows = false;
  plant.inputs[0] = {
      .condition = AxisCondition::disabled, .actual = {.position = 3.0}, .set_point = {}};
  plant.step();
  EXPECT_EQ(plant.last[0].commanded.position, 3.0);
  plant.inputs[0] = {
      .condition = AxisCondition::enabled, .actual = {.position = 3.5}, .set_point = {}};
  plant.step();
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  EXPECT_EQ(plant.last[0].commanded.position, 3.5);
  plant.inputs[0].actual.position = 3.4;
  plant.step();
  EXPECT_EQ(plant.last[0].commanded.position, 3.5);
  EXPECT_NEAR(plant.last[0].following_error, 0.1, 1e-12);
}

TEST(AxisOrders, RefusesWhatWouldJumpAndGoesOn) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 1.0}, 1)));
  plant.steps(100);
  plant.ids = 2;
  MotionOrder late = plant.order(0, {.position = 2.0});
  late.begin = plant.cycle;
  ASSERT_TRUE(plant.take(late));
  plant.step();
  EXPECT_EQ(plant.ended[0].outcome, Outcome::too_late);
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 2.0}, 5)));
  plant.steps(5);
  EXPECT_EQ(plant.ended[0].id, 2U);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::other_start);
  EXPECT_EQ(plant.last[0].state, AxisState::moving);
  EXPECT_EQ(plant.last[0].running, 1U);
}

TEST(AxisOrders, RefusesOrdersOfADriveThatIsNotEnabledOrStopsAndOfUnknownAxes) {
  Plant plant{1};
  plant.inputs[0].condition = AxisCondition::disabled;
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 1.0}, 1)));
  plant.step();
  EXPECT_EQ(plant.ended[0].outcome, Outcome::not_powered);
  plant.inputs[0].condition = AxisCondition::enabled;
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 1.0}, 1)));
  plant.steps(200);
  plant.motions.stop_axis(0, StopCause::application);
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 1.0}, 1)));
  plant.step();
  EXPECT_EQ(plant.ended[0].outcome, Outcome::is_stopping);
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::application);
  MotionOrder order = plant.order(0, {.position = 1.0});
  order.axis = 1;
  EXPECT_FALSE(plant.take(order));
  order.axis = 0;
  order.group = max_axes;
  EXPECT_FALSE(plant.take(order));
}

TEST(AxisOrders, RefusesAMotionThatWouldEndWithAJump) {
  Plant plant{1};
  plant.step();
  MotionOrder order = plant.order(0, {}, 1);
  order.profile = Plant::plan({}, {.velocity = 0.5}, Goal::velocity);
  ASSERT_TRUE(plant.take(order));
  plant.step();
  EXPECT_EQ(plant.ended[0].outcome, Outcome::no_rest);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
}

TEST(AxisOrders, ALaterOrderThatWaitsReplacesTheEarlierOne) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 1.0})));
  plant.ids = 2;
  EXPECT_EQ(plant.motions.take(plant.order(0, {.position = 2.0})), Outcome::second_in_cycle);
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 2.0})));
  plant.step();
  EXPECT_EQ(plant.ended[0].id, 1U);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::replaced);
  plant.steps(10);
  EXPECT_EQ(plant.last[0].running, 2U);
}

TEST(AxisOrders, RefusesOrdersWithNumbersThatWouldHideAFault) {
  Plant plant{1};
  plant.step();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](auto change) {
    MotionOrder order = plant.order(0, {.position = 1.0});
    change(order);
    return plant.motions.take(order) == Outcome::unsound;
  };
  EXPECT_TRUE(refused([&](MotionOrder& order) { order.max_following_error = nan; }));
  EXPECT_TRUE(refused([&](MotionOrder& order) { order.from.velocity = nan; }));
  EXPECT_TRUE(refused([&](MotionOrder& order) { order.stop.jerk = nan; }));
  EXPECT_TRUE(refused([&](MotionOrder& order) { order.stop.min_acceleration = 0.0; }));
  EXPECT_TRUE(refused([&](MotionOrder& order) { order.profile.add(0.1, nan); }));
  EXPECT_TRUE(refused([&](MotionOrder& order) { order.id = 0; }));
  EXPECT_TRUE(refused([&](MotionOrder& order) { order.sender = max_axes; }));
  EXPECT_FALSE(refused([](MotionOrder&) {}));
}

TEST(AxisOrders, ADirectSetPointMovesTheStartOfTheNextMotion) {
  Plant plant{1};
  plant.step();
  plant.inputs[0].set_point = 0.25;
  plant.step();
  EXPECT_EQ(plant.last[0].commanded.position, 0.25);
  plant.inputs[0].set_point.reset();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 0.5}, 1)));
  plant.step();
  EXPECT_EQ(plant.last[0].state, AxisState::moving);
  EXPECT_EQ(plant.last[0].commanded.position, 0.25);
}

TEST(AxisOrders, AnOrderOfASilentSenderDoesNotBegin) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 5.0}, 501)));
  plant.steps(501);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::sender_was_silent);
}

TEST(AxisOrders, AnOrderIsNoSignOfLife) {
  Plant plant{1};
  plant.steps(600);
  EXPECT_EQ(plant.motions.take(plant.order(0, {.position = 5.0}, 1)), Outcome::none);
  plant.step();
  EXPECT_EQ(plant.ended[0].outcome, Outcome::sender_was_silent);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
}

TEST(AxisOrders, TheOrdersOfAGroupBeginTogetherOrNotAtAll) {
  Plant plant{2};
  plant.step();
  MotionOrder first = plant.order(0, {.position = 1.0}, 1);
  first.axes = 2;
  ASSERT_TRUE(plant.take(first));
  plant.step();
  EXPECT_EQ(plant.ended[0].outcome, Outcome::group_incomplete);
  first.begin = plant.cycle + 1;
  MotionOrder second = first;  // group 0
  second.axis = 1;
  second.from.position = 1.0;
  ASSERT_TRUE(plant.take(first));
  ASSERT_TRUE(plant.take(second));
  plant.step();
  EXPECT_EQ(plant.ended[0].outcome, Outcome::group_incomplete);
  EXPECT_EQ(plant.ended[1].outcome, Outcome::other_start);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
}

TEST(AxisOrders, RandomOrdersAndStopsNeverJumpAndKeepTheLimits) {
  std::mt19937_64 random{15};
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  Plant plant{4};
  plant.step();
  struct Planned {
    State from;
    Profile profile;
    CycleNumber begin = 0;

    State at(CycleNumber cycle) const {
      return profile.at(from, static_cast<double>(cycle - begin) * Plant::period);
    }
  };
  std::array<Planned, 4> planned;
  std::array<int, 16> outcomes{};
  for (int round = 0; round < 4000; ++round) {
    const auto axis = static_cast<std::uint8_t>(random() % 4);
    MotionOrder order = plant.order(axis, {.position = between(-1.0, 1.0)}, 1);
    const bool moves = plant.last[axis].state == AxisState::moving;
    // The planner knows the motion that runs: it plans from the state of the next beat.
    if (moves && random() % 4 != 0) order.from = planned[axis].at(order.begin);
    order.profile = Plant::plan(order.from, {.position = between(-1.0, 1.0)});
    order.id = static_cast<std::uint32_t>(round + 1);
    order.group = axis;
    ASSERT_TRUE(plant.take(order));
    plant.step();
    ++outcomes[static_cast<std::size_t>(plant.ended[axis].outcome)];
    if (plant.last[axis].running == order.id)
      planned[axis] = {order.from, order.profile, order.begin};
    if (random() % 8 == 0) plant.motions.stop_axis(axis, StopCause::application);
    plant.steps(static_cast<int>(random() % 60));
    if (testing::Test::HasFatalFailure()) return;
  }
  for (const Outcome seen :
       {Outcome::stopped, Outcome::replaced, Outcome::other_start, Outcome::is_stopping}) {
    EXPECT_GT(outcomes[static_cast<std::size_t>(seen)], 50);
  }
}

}  // namespace
}  // namespace takt::motion
