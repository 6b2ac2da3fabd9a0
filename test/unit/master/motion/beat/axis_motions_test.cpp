#include "master/motion/beat/axis_motions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "master/motion/beat/stop_profile.hpp"
#include "master/motion/trajectory.hpp"

namespace takt::motion {
namespace {

constexpr double period = 0.001;
constexpr Limits limits{.max_velocity = 1.0,
                        .min_velocity = -0.5,
                        .max_acceleration = 5.0,
                        .min_acceleration = -4.0,
                        .jerk = 50.0};

Profile plan(const State& from, const State& to, Goal goal = Goal::position) {
  const std::array tasks{AxisTask{.from = from, .to = to, .limits = limits}};
  std::array<PlannedAxis, 1> planned;
  EXPECT_TRUE(plan_trajectory(tasks, {.goal = goal}, planned).has_value());
  return planned[0].profile;
}

/// Axes whose drives follow at once, and a judge of each beat.
class Plant {
 public:
  explicit Plant(std::size_t axes) : motions{axes, period}, inputs(axes), last(axes), ended(axes) {
    for (AxisInput& input : inputs) input.condition = AxisCondition::enabled;
  }

  void step() {
    ++beat;
    const auto reports = motions.run(beat, inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const bool powered =
          last[i].state != AxisState::unpowered && reports[i].state != AxisState::unpowered;
      if (powered && !inputs[i].set_point) judge(last[i].commanded, reports[i].commanded);
      last[i] = reports[i];
      for (const EndedOrder& order : reports[i].ended.orders()) ended[i] = order;
      if (follows) inputs[i].actual = reports[i].commanded;
    }
  }

  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }

  MotionOrder order(std::uint8_t axis, const State& to, BeatNumber ahead = 10) const {
    const State& from = last[axis].commanded;
    return {.id = ids,
            .axis = axis,
            .group = axis,
            .begin = beat + ahead,
            .from = from,
            .profile = plan(from, to),
            .stop = limits,
            .timeout = 500};
  }

  /// Takes the order and a sign of life of its sender.
  bool take(const MotionOrder& order) {
    motions.sender_heard(order.sender, beat);
    return motions.take(order) == Outcome::none;
  }

  AxisMotions motions;
  std::vector<AxisInput> inputs;
  std::vector<AxisReport> last;
  std::vector<EndedOrder> ended;  ///< of each axis, the order that ended last
  BeatNumber beat = 0;
  std::uint32_t ids = 1;
  bool follows = true;

 private:
  /// No jump: what changes in one beat keeps the limit of the jerk, and all limits hold.
  static void judge(const State& before, const State& now) {
    constexpr double tolerance = 1e-9;
    ASSERT_LE(now.velocity, limits.max_velocity + tolerance);
    ASSERT_GE(now.velocity, limits.min_velocity - tolerance);
    ASSERT_LE(now.acceleration, limits.max_acceleration + tolerance);
    ASSERT_GE(now.acceleration, limits.min_acceleration - tolerance);
    ASSERT_LE(std::abs(now.acceleration - before.acceleration), limits.jerk * period + tolerance);
    const State free = advanced(before, period, 0.0);
    ASSERT_LE(std::abs(now.velocity - free.velocity),
              limits.jerk * period * period / 2 + tolerance);
    ASSERT_LE(std::abs(now.position - free.position),
              limits.jerk * period * period * period / 6 + tolerance);
  }
};

TEST(AxisMotions, AnOrderBeginsInItsBeatAndEndsAtItsTarget) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 0.02})));
  plant.steps(9);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  plant.step();
  EXPECT_EQ(plant.last[0].state, AxisState::moving);
  EXPECT_EQ(plant.last[0].commanded.position, 0.0);
  EXPECT_EQ(plant.last[0].running, 1U);
  const BeatNumber left = plant.last[0].beats_left;
  plant.steps(static_cast<int>(left));
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::done);
  EXPECT_NEAR(plant.last[0].commanded.position, 0.02, 1e-12);
}

TEST(AxisMotions, AnAxisThatIsNotEnabledFollowsItsActualPosition) {
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

TEST(AxisMotions, RefusesWhatWouldJumpAndGoesOn) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 1.0}, 1)));
  plant.steps(100);
  plant.ids = 2;
  MotionOrder late = plant.order(0, {.position = 2.0});
  late.begin = plant.beat;
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

TEST(AxisMotions, RefusesOrdersOfADriveThatIsNotEnabledOrStopsAndOfUnknownAxes) {
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

TEST(AxisMotions, RefusesAMotionThatWouldEndWithAJump) {
  Plant plant{1};
  plant.step();
  MotionOrder order = plant.order(0, {}, 1);
  order.profile = plan({}, {.velocity = 0.5}, Goal::velocity);
  ASSERT_TRUE(plant.take(order));
  plant.step();
  EXPECT_EQ(plant.ended[0].outcome, Outcome::no_rest);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
}

TEST(AxisMotions, ALaterOrderThatWaitsReplacesTheEarlierOne) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 1.0})));
  plant.ids = 2;
  EXPECT_EQ(plant.motions.take(plant.order(0, {.position = 2.0})), Outcome::second_in_beat);
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 2.0})));
  plant.step();
  EXPECT_EQ(plant.ended[0].id, 1U);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::replaced);
  plant.steps(10);
  EXPECT_EQ(plant.last[0].running, 2U);
}

TEST(AxisMotions, RefusesOrdersWithNumbersThatWouldHideAFault) {
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

TEST(AxisMotions, ADirectSetPointMovesTheStartOfTheNextMotion) {
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

TEST(AxisMotions, AnAxisIsKeptAliveWhileItMovesOrItsSenderIsAlive) {
  Plant plant{1};
  plant.step();
  EXPECT_FALSE(plant.last[0].kept_alive);
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 0.001}, 1)));
  plant.steps(500);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  EXPECT_TRUE(plant.last[0].kept_alive);
  plant.step();
  EXPECT_FALSE(plant.last[0].kept_alive);
  plant.motions.sender_heard(0, plant.beat);
  plant.step();
  EXPECT_TRUE(plant.last[0].kept_alive);
}

TEST(AxisMotions, AMotionOutlivesItsSenderByTheTimeout) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 5.0}, 1)));
  plant.steps(400);
  plant.motions.sender_heard(0, plant.beat);
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
TEST(AxisMotions, AMotionStopsWhenItsSenderMayNotCommandTheAxisAnyLonger) {
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
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::sender_silent);
}

TEST(AxisMotions, AnOrderOfASilentSenderDoesNotBegin) {
  Plant plant{1};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 5.0}, 501)));
  plant.steps(501);
  EXPECT_EQ(plant.ended[0].outcome, Outcome::sender_was_silent);
}

TEST(AxisMotions, AnOrderIsNoSignOfLife) {
  Plant plant{1};
  plant.steps(600);
  EXPECT_EQ(plant.motions.take(plant.order(0, {.position = 5.0}, 1)), Outcome::none);
  plant.step();
  EXPECT_EQ(plant.ended[0].outcome, Outcome::sender_was_silent);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
}

/// Starts a motion of three axes, of which the last is in a group of its own.
void start_groups(Plant& plant) {
  plant.step();
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    MotionOrder order = plant.order(axis, {.position = 1.0 + axis}, 1);
    order.group = axis == 2 ? 2 : 0;
    order.axes = axis == 2 ? 1 : 2;
    order.timeout = 100000;
    order.max_following_error = 0.1;
    ASSERT_TRUE(plant.take(order));
  }
  plant.steps(300);
}

TEST(AxisMotions, AGroupStopsInTheBeatInWhichOneOfItsAxesFails) {
  struct Case {
    AxisCondition condition;
    StopCause cause;
  };
  for (const Case& failure : {Case{AxisCondition::fault, StopCause::fault},
                              Case{AxisCondition::lost, StopCause::node_lost},
                              Case{AxisCondition::disabled, StopCause::disabled}}) {
    Plant plant{3};
    start_groups(plant);
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

/// The drive may still follow its set-points, so the axis itself stops along its limits as well.
TEST(AxisMotions, AnAxisThatIsHaltedOrSilentStopsAlongItsLimitsAndTakesNoOrderMeanwhile) {
  struct Case {
    AxisCondition condition;
    StopCause cause;
  };
  for (const Case& failure : {Case{AxisCondition::halted, StopCause::halted},
                              Case{AxisCondition::silent, StopCause::no_statusword}}) {
    Plant plant{3};
    start_groups(plant);
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

TEST(AxisMotions, AHaltDoesNotStopTheNextMotionsOfAGroupAgain) {
  Plant plant{3};
  start_groups(plant);
  plant.inputs[1].condition = AxisCondition::halted;
  plant.steps(1000);
  ASSERT_EQ(plant.last[0].state, AxisState::standing);
  plant.ids = 2;
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 0.0})));
  plant.steps(10);
  EXPECT_EQ(plant.last[0].state, AxisState::moving);
}

TEST(AxisMotions, AGroupStopsForAFollowingErrorAndAllStopForAnOrderedStop) {
  Plant plant{3};
  start_groups(plant);
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

TEST(AxisMotions, TheOrdersOfAGroupBeginTogetherOrNotAtAll) {
  Plant plant{2};
  plant.step();
  MotionOrder first = plant.order(0, {.position = 1.0}, 1);
  first.axes = 2;
  ASSERT_TRUE(plant.take(first));
  plant.step();
  EXPECT_EQ(plant.ended[0].outcome, Outcome::group_incomplete);
  first.begin = plant.beat + 1;
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

TEST(AxisMotions, OneMotionThatReplacesPartOfAGroupLeavesTheRestAlone) {
  Plant plant{3};
  start_groups(plant);
  plant.ids = 2;
  MotionOrder order = plant.order(0, {.position = 0.0}, 1);
  order.from = plan({}, {.position = 1.0}).at({}, 0.3);
  order.profile = plan(order.from, {});
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
TEST(AxisMotions, AnAbandonedAxisStopsNoLaterMotionOfItsGroup) {
  Plant plant{3};
  start_groups(plant);
  plant.motions.abandon(0, StopCause::limit);
  plant.inputs[0].set_point = plant.last[0].commanded.position;  // no judgement of the jump
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

TEST(AxisMotions, AxesWhoseMotionsEndAtOnceAreKeptAliveWhileTheirSenderIsAlive) {
  Plant plant{2};
  plant.step();
  ASSERT_TRUE(plant.take(plant.order(0, {.position = 0.001}, 1)));
  ASSERT_TRUE(plant.take(plant.order(1, {.position = 5.0}, 1)));
  plant.steps(400);
  ASSERT_EQ(plant.last[0].state, AxisState::standing);
  ASSERT_EQ(plant.last[1].state, AxisState::moving);
  plant.motions.abandon_all(StopCause::no_sync);
  plant.inputs[1].set_point = plant.last[1].commanded.position;  // no judgement of the jump
  plant.step();
  for (const AxisReport& report : plant.last) {
    EXPECT_EQ(report.state, AxisState::standing);
    EXPECT_TRUE(report.kept_alive);
  }
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::none);
  EXPECT_EQ(plant.last[1].stop.cause, StopCause::no_sync);
  EXPECT_TRUE(plant.motions.outlives_gap(0, plant.beat + 99));
  EXPECT_FALSE(plant.motions.outlives_gap(0, plant.beat + 100)) << "its sender is silent";
}

TEST(AxisMotions, TheReportKeepsTheFirstCauseOfAStop) {
  Plant plant{3};
  start_groups(plant);
  plant.inputs[0].actual.position -= 0.2;
  plant.step();
  plant.inputs[1].condition = AxisCondition::fault;
  plant.step();
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::following_error);
  EXPECT_EQ(plant.last[0].stop.axis, 0);
}

TEST(AxisMotions, AJogKeepsItsVelocityAndStopsInsideTheRange) {
  Plant plant{1};
  plant.step();
  const PositionRange range{.min = -1.0, .max = 2.0};
  MotionOrder jog = plant.order(0, {}, 1);
  jog.profile = plan({}, {.velocity = 0.8}, Goal::velocity);
  jog.ending = Ending::cruise;
  jog.timeout = 100000;
  const auto latest = beats_with_stop(jog, range, period, 100000);
  ASSERT_TRUE(latest.has_value());
  jog.latest_stop = *latest;
  ASSERT_TRUE(plant.take(jog));
  plant.steps(1000);
  EXPECT_NEAR(plant.last[0].commanded.velocity, 0.8, 1e-12);
  plant.steps(4000);
  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::end_of_range);
  EXPECT_LE(plant.last[0].commanded.position, range.max + 1e-8);
  EXPECT_GE(plant.last[0].commanded.position, range.max - 0.8 * period);
}

TEST(AxisMotions, NoStopStaysInsideARangeThatTheAxisIsAboutToLeave) {
  MotionOrder order;
  order.from.velocity = 1.0;
  order.stop = limits;
  order.ending = Ending::cruise;
  EXPECT_EQ(beats_with_stop(order, {.max = 0.01}, period, 10), std::nullopt);
}

TEST(AxisMotions, RandomOrdersAndStopsNeverJumpAndKeepTheLimits) {
  std::mt19937_64 random{15};
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  Plant plant{4};
  plant.step();
  struct Planned {
    State from;
    Profile profile;
    BeatNumber begin = 0;

    State at(BeatNumber beat) const {
      return profile.at(from, static_cast<double>(beat - begin) * period);
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
    order.profile = plan(order.from, {.position = between(-1.0, 1.0)});
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
