#include <gtest/gtest.h>
#include <optional>

#include "master/motion/beat/stop_profile.hpp"
#include "test/unit/master/motion/beat/plant.hpp"

namespace takt::motion {
namespace {

using test::Plant;

TEST(MotionStops, AnAxisIsKeptAliveWhileItMovesOrItsSenderIsAlive) {
  Plant plant{1};
  plant.step();
  EXPECT_FALSE(plant.last[0].kept_alive);
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 0.001}, 1)));
  plant.steps(500);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  EXPECT_TRUE(plant.last[0].kept_alive);
  plant.step();
  EXPECT_FALSE(plant.last[0].kept_alive);
  plant.motions.sender_heard(0, plant.cycle);
  plant.step();
  EXPECT_TRUE(plant.last[0].kept_alive);
}

TEST(MotionStops, AMotionOutlivesItsSenderByTheTimeout) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 5.0}, 1)));
  plant.steps(400);
  plant.motions.sender_heard(0, plant.cycle);
  plant.steps(500);
  EXPECT_EQ(plant.last[0].state, AxisState::moving);
  plant.step();
  EXPECT_EQ(plant.last[0].state, AxisState::stopping);
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::sender_silent);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::stopped);
  plant.steps(1000);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  EXPECT_EQ(plant.last[0].commanded.velocity, 0.0);
}

/// The motion is younger than its timeout.
TEST(MotionStops, AMotionStopsWhenItsSenderMayNotCommandTheAxisAnyLonger) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 5.0}, 1)));
  plant.steps(100);
  plant.motions.sender_left(0, 1);
  plant.step();
  EXPECT_EQ(plant.last[0].state, AxisState::moving) << "another sender has left";
  plant.motions.sender_left(0, 0);
  plant.step();
  EXPECT_EQ(plant.last[0].state, AxisState::stopping);
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::sender_left);
}

/// The plant checks each step as if it took one period.
TEST(MotionStops, WhereBeatsAreMissingTheMotionAndItsStopAreDelayedByTheirPeriods) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 5.0}, 1)));
  plant.steps(300);
  const CycleNumber left = plant.last[0].cycles_left;
  ++plant.cycle;
  plant.step();
  EXPECT_EQ(plant.last[0].cycles_left, left - 1);
  plant.cycle += 2;
  plant.motions.stop_axis(0, StopCause::application);
  plant.step();
  ASSERT_EQ(plant.last[0].state, AxisState::stopping);
  ++plant.cycle;
  plant.steps(1000);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
}

/// The next set-point would be twice as far from the last one that the drive has received.
TEST(MotionStops, AMotionWaitsForASetPointThatWasNotSent) {
  Plant plant{2};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 5.0}, 1)));
  plant.steps(300);
  const State before = plant.last[0].commanded;
  const CycleNumber left = plant.last[0].cycles_left;
  plant.inputs[0].is_unsent = true;
  plant.inputs[0].set_point = before.position;  // so that the plant does not check the step
  plant.step();
  EXPECT_EQ(plant.last[0].commanded.position, before.position);
  EXPECT_EQ(plant.last[0].cycles_left, left);
  plant.motions.stop_axis(0, StopCause::application);
  plant.step();
  EXPECT_EQ(plant.last[0].commanded.position, before.position) << "its stop waits as well";
  plant.inputs[0].is_unsent = false;
  plant.inputs[0].set_point.reset();
  plant.steps(1000);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
}

/// A motion that went on would reach the drive as one step.
TEST(MotionStops, AnAxisWhoseSetPointsAreNotSentStandsAtOnceAndItsGroupStops) {
  Plant plant{3};
  plant.start_groups();
  const double before = plant.last[1].commanded.position;
  plant.inputs[1].condition = AxisCondition::unsent;
  plant.inputs[1].set_point = before;  // so that the plant does not check the step of the velocity
  plant.step();
  EXPECT_EQ(plant.last[1].state, AxisState::standing);
  EXPECT_EQ(plant.last[1].commanded.position, before);
  EXPECT_EQ(plant.last[0].state, AxisState::stopping);
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::not_sent);
  EXPECT_EQ(plant.last[0].stop.axis, 1);
  EXPECT_EQ(plant.last[2].state, AxisState::moving);
  EXPECT_TRUE(plant.last[1].kept_alive);
  ASSERT_TRUE(plant.take(plant.order(1, {.position = 9.0}, 1)));
  plant.step();
  EXPECT_EQ(plant.ended[1].outcome, Outcome::not_powered);
  EXPECT_EQ(plant.last[1].state, AxisState::standing);
}

TEST(MotionStops, AGroupStopsInTheBeatInWhichOneOfItsAxesFails) {
  struct Case {
    AxisCondition condition;
    StopCause cause;
  };
  for (const Case& failure : {Case{AxisCondition::fault, StopCause::fault},
                              Case{AxisCondition::lost, StopCause::node_lost},
                              Case{AxisCondition::disabled, StopCause::disabled}}) {
    Plant plant{3};
    plant.start_groups();
    plant.inputs[1].condition = failure.condition;
    plant.step();
    EXPECT_EQ(plant.last[0].state, AxisState::stopping);
    EXPECT_EQ(plant.last[0].stop.cause, failure.cause);
    EXPECT_EQ(plant.last[0].stop.axis, 1);
    EXPECT_EQ(plant.last[1].state, AxisState::unpowered);
    EXPECT_EQ(plant.last[1].stop.cause, failure.cause);
    EXPECT_EQ(plant.ended[1].outcome, Outcome::stopped);
    EXPECT_EQ(plant.last[2].state, AxisState::moving);
  }
}

/// The drive may still follow its set-points, so the axis itself stops along its Plant::limits as
/// well.
TEST(MotionStops, AnAxisThatIsHaltedOrSilentStopsAlongItsLimitsAndTakesNoOrderMeanwhile) {
  struct Case {
    AxisCondition condition;
    StopCause cause;
  };
  for (const Case& failure : {Case{AxisCondition::halted, StopCause::halted},
                              Case{AxisCondition::silent, StopCause::no_statusword}}) {
    Plant plant{3};
    plant.start_groups();
    plant.inputs[1].condition = failure.condition;
    plant.step();
    for (const std::size_t axis : {0U, 1U}) {
      EXPECT_EQ(plant.last[axis].state, AxisState::stopping);
      EXPECT_EQ(plant.last[axis].stop.cause, failure.cause);
      EXPECT_EQ(plant.last[axis].stop.axis, 1);
    }
    EXPECT_EQ(plant.last[2].state, AxisState::moving);
    plant.steps(1000);
    EXPECT_EQ(plant.last[1].state, AxisState::standing);
    plant.ids = 2;
    ASSERT_TRUE(plant.take(plant.order(1, {.position = 0.0}, 1)));
    plant.step();
    EXPECT_EQ(plant.ended[1].outcome, Outcome::not_powered);
    plant.inputs[1].condition = AxisCondition::enabled;
    plant.step();
    ASSERT_TRUE(plant.take(plant.order(1, {.position = 0.0}, 1)));
    plant.step();
    EXPECT_EQ(plant.last[1].state, AxisState::moving);
  }
}

TEST(MotionStops, AHaltDoesNotStopTheNextMotionsOfAGroupAgain) {
  Plant plant{3};
  plant.start_groups();
  plant.inputs[1].condition = AxisCondition::halted;
  plant.steps(1000);
  ASSERT_EQ(plant.last[0].state, AxisState::standing);
  plant.ids = 2;
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 0.0})));
  plant.steps(10);
  EXPECT_EQ(plant.last[0].state, AxisState::moving);
}

TEST(MotionStops, AGroupStopsForAFollowingErrorAndAllStopForAnOrderedStop) {
  Plant plant{3};
  plant.start_groups();
  plant.inputs[0].actual.position -= 0.2;
  plant.step();
  EXPECT_EQ(plant.last[1].stop.cause, StopCause::following_error);
  EXPECT_EQ(plant.last[1].state, AxisState::stopping);
  EXPECT_EQ(plant.last[2].state, AxisState::moving);
  plant.motions.stop_all(StopCause::ordered_stop);
  plant.step();
  EXPECT_EQ(plant.last[2].stop.cause, StopCause::ordered_stop);
  EXPECT_EQ(plant.last[2].state, AxisState::stopping);
}

TEST(MotionStops, OneMotionThatReplacesPartOfAGroupLeavesTheRestAlone) {
  Plant plant{3};
  plant.start_groups();
  plant.ids = 2;
  MotionOrder order = plant.order(0, {.position = 0.0}, 1);
  order.from = Plant::plan({}, {.position = 1.0}).at({}, 0.3);
  order.profile = Plant::plan(order.from, {});
  order.timeout = 100000;
  ASSERT_TRUE(plant.take(order));
  plant.step();
  ASSERT_EQ(plant.last[0].running, 2U);
  ASSERT_EQ(plant.last[1].running, 1U);
  plant.inputs[1].condition = AxisCondition::fault;
  plant.step();
  EXPECT_EQ(plant.last[1].stop.cause, StopCause::fault);
  EXPECT_EQ(plant.last[0].state, AxisState::moving);
}

/// The axis with the number of the group is the one that was abandoned.
TEST(MotionStops, AnAbandonedAxisStopsNoLaterMotionOfItsGroup) {
  Plant plant{3};
  plant.start_groups();
  plant.motions.abandon(0, StopCause::limit);
  plant.inputs[0].set_point = plant.last[0].commanded.position;  // no check of the jump
  plant.steps(1000);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  EXPECT_FALSE(plant.last[0].kept_alive);
  EXPECT_EQ(plant.last[1].stop.cause, StopCause::limit);
  ASSERT_EQ(plant.last[1].state, AxisState::standing);
  plant.ids = 2;
  ASSERT_TRUE(plant.take(plant.order(1, {.position = 0.0})));
  plant.inputs[0].condition = AxisCondition::fault;
  plant.steps(10);
  EXPECT_EQ(plant.last[1].state, AxisState::moving);
}

TEST(MotionStops, AxesWhoseMotionsEndAtOnceAreKeptAliveWhileTheirSenderIsAlive) {
  Plant plant{2};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 0.001}, 1)));
  ASSERT_TRUE(plant.take(plant.order(1, {.position = 5.0}, 1)));
  plant.steps(400);
  ASSERT_EQ(plant.last[0].state, AxisState::standing);
  ASSERT_EQ(plant.last[1].state, AxisState::moving);
  plant.motions.abandon_all(StopCause::no_sync);
  plant.inputs[1].set_point = plant.last[1].commanded.position;  // no check of the jump
  plant.step();
  for (const AxisReport& report : plant.last) {
    EXPECT_EQ(report.state, AxisState::standing);
    EXPECT_TRUE(report.kept_alive);
  }
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::none);
  EXPECT_EQ(plant.last[1].stop.cause, StopCause::no_sync);
  EXPECT_EQ(plant.last[1].stop.axis, 1) << "no other axis is the cause";
  EXPECT_TRUE(plant.motions.outlives_gap(0, plant.cycle + 99));
  EXPECT_FALSE(plant.motions.outlives_gap(0, plant.cycle + 100)) << "its sender is silent";
}

TEST(MotionStops, TheReportKeepsTheFirstCauseOfAStop) {
  Plant plant{3};
  plant.start_groups();
  plant.inputs[0].actual.position -= 0.2;
  plant.step();
  plant.inputs[1].condition = AxisCondition::fault;
  plant.step();
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::following_error);
  EXPECT_EQ(plant.last[0].stop.axis, 0);
}

/// The axis is at standstill, and an older motion of it has ended by another cause.
TEST(MotionStops, TheReportHasTheCauseThatEndsAnOrderWhichWaits) {
  Plant plant{2};
  plant.step();
  MotionOrder first = plant.order(0, {.position = 5.0}, 1);
  first.max_following_error = 0.1;
  ASSERT_TRUE(plant.take(first));
  plant.steps(200);
  plant.inputs[0].actual.position -= 0.2;
  plant.steps(1000);
  ASSERT_EQ(plant.last[0].state, AxisState::standing);
  ASSERT_EQ(plant.last[0].stop.cause, StopCause::following_error);

  for (std::uint8_t axis = 0; axis < 2; ++axis) {
    ASSERT_TRUE(plant.take(plant.order(axis, {.position = 1.0}, 10)));
  }
  plant.motions.abandon_all(StopCause::no_sync);
  plant.step();
  for (std::uint8_t axis = 0; axis < 2; ++axis) {
    EXPECT_EQ(plant.ended[axis].outcome, Outcome::stopped);
    EXPECT_EQ(plant.last[axis].stop.cause, StopCause::no_sync);
    EXPECT_EQ(plant.last[axis].stop.axis, axis);
  }
}

TEST(MotionStops, AJogKeepsItsVelocityAndStopsInsideTheRange) {
  Plant plant{1};
  plant.step();
  const PositionRange range{.min = -1.0, .max = 2.0};
  MotionOrder jog = plant.order(0, {}, 1);
  jog.profile = Plant::plan({}, {.velocity = 0.8}, Goal::velocity);
  jog.ending = Ending::cruise;
  jog.timeout = 100000;
  const auto latest = cycles_with_stop(jog, range, Plant::period, 100000);
  ASSERT_TRUE(latest.has_value());
  jog.latest_stop = *latest;
  ASSERT_TRUE(plant.take(jog));
  plant.steps(1000);
  EXPECT_NEAR(plant.last[0].commanded.velocity, 0.8, 1e-12);
  plant.steps(4000);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::end_of_range);
  EXPECT_LE(plant.last[0].commanded.position, range.max + 1e-8);
  EXPECT_GE(plant.last[0].commanded.position, range.max - 0.8 * Plant::period);
}

TEST(MotionStops, NoStopStaysInsideARangeThatTheAxisIsAboutToLeave) {
  MotionOrder order;
  order.from.velocity = 1.0;
  order.stop = Plant::limits;
  order.ending = Ending::cruise;
  EXPECT_EQ(cycles_with_stop(order, {.max = 0.01}, Plant::period, 10), std::nullopt);
}

}  // namespace
}  // namespace takt::motion
