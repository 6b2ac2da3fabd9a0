#include <cmath>
#include <gtest/gtest.h>

#include "test/unit/master/motion/beat/gears.hpp"

namespace takt::motion {
namespace {

using test::behind_axis;
using test::gear_order;
using test::jog;
using test::Plant;

constexpr double period = Plant::period;

TEST(AxisGears, AnAxisLocksToAMovingAxisAndFollowsItExactly) {
  Plant plant{2};
  plant.step();
  ASSERT_TRUE(plant.take(jog(plant, 0.6)));
  plant.steps(700);
  plant.ids = 2;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, behind_axis(-0.5))));
  plant.steps(1);
  EXPECT_EQ(plant.last[1].gear, GearPhase::approaching);
  plant.steps(1000);

  ASSERT_EQ(plant.last[1].gear, GearPhase::locked);
  const double offset = plant.last[1].commanded.position + 0.5 * plant.last[0].commanded.position;
  for (int beat = 0; beat < 3000; ++beat) {
    if (beat == 1000) plant.motions.stop_axis(0, StopCause::application);
    plant.step();
    EXPECT_EQ(plant.last[1].gear, GearPhase::locked) << beat;
    EXPECT_NEAR(plant.last[1].commanded.position, offset - 0.5 * plant.last[0].commanded.position,
                5e-8);
  }
  EXPECT_EQ(plant.last[1].state, AxisState::moving);
  EXPECT_NEAR(plant.last[1].commanded.velocity, 0.0, 1e-9);
}

TEST(AxisGears, AGearWithAPhaseCatchesUpItsPosition) {
  Plant plant{2};
  plant.step();
  ASSERT_TRUE(plant.take(jog(plant, 0.4)));
  plant.ids = 2;
  GearTask task = behind_axis(1.0);
  task.match = PhaseMatch::at;
  task.offset = 0.7;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, task)));
  plant.steps(4000);

  EXPECT_EQ(plant.last[1].gear, GearPhase::locked);
  EXPECT_NEAR(plant.last[1].phase_error, 0.0, 1e-9);
  EXPECT_NEAR(plant.last[1].commanded.position, plant.last[0].commanded.position + 0.7, 1e-9);
}

/// A turn is 1 unit. The leader has made three turns, and the axis is at standstill in its own
/// second turn.
TEST(AxisGears, APhaseOfRotaryAxesIsTheNearestOne) {
  Plant plant{2};
  plant.inputs[1].set_point = 1.2;
  plant.step();
  plant.step();
  plant.inputs[1].set_point = {};
  MotionOrder move = plant.order(0, {.position = 3.1}, 1);
  move.timeout = 100'000;
  ASSERT_TRUE(plant.take(move));
  plant.steps(6000);
  ASSERT_NEAR(plant.last[0].commanded.position, 3.1, 1e-9);
  plant.ids = 2;
  GearTask task = behind_axis(0.5);
  task.match = PhaseMatch::at;
  task.offset = 0.85;
  task.modulo = task.turn = 1.0;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, task)));
  plant.steps(3000);

  EXPECT_EQ(plant.last[1].gear, GearPhase::locked);
  EXPECT_NEAR(plant.last[1].commanded.position, 0.5 * 0.1 + 0.85, 1e-9);
}

TEST(AxisGears, AnAxisThatIsTooSlowFallsBehindAndCatchesUpLater) {
  Plant plant{2};
  plant.step();
  plant.ids = 2;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, behind_axis(3.0))));
  plant.steps(5);
  ASSERT_EQ(plant.last[1].gear, GearPhase::locked);
  plant.ids = 3;
  ASSERT_TRUE(plant.take(jog(plant, 0.9)));
  plant.steps(1000);
  EXPECT_EQ(plant.last[1].gear, GearPhase::approaching);
  EXPECT_LT(plant.last[1].phase_error, -0.5);
  plant.motions.stop_axis(0, StopCause::application);
  plant.steps(6000);

  EXPECT_EQ(plant.last[1].gear, GearPhase::locked);
  EXPECT_NEAR(plant.last[1].commanded.position, 3.0 * plant.last[0].commanded.position, 1e-9);
}

TEST(AxisGears, ALargePhaseErrorStopsALockedAxis) {
  Plant plant{2};
  plant.step();
  plant.ids = 2;
  GearTask task = behind_axis(3.0);
  task.max_phase_error = 0.1;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, task)));
  plant.steps(5);
  plant.ids = 3;
  ASSERT_TRUE(plant.take(jog(plant, 0.9)));
  plant.steps(1500);

  EXPECT_EQ(plant.last[1].state, AxisState::standing);
  EXPECT_EQ(plant.last[1].stop.cause, StopCause::phase_error);
  EXPECT_EQ(plant.ended[1].outcome, Outcome::stopped);
}

TEST(AxisGears, AnAxisStopsInsideItsRange) {
  Plant plant{2};
  plant.step();
  plant.ids = 2;
  GearTask task = behind_axis(1.0);
  task.range = {.min = -1.0, .max = 0.8};
  ASSERT_TRUE(plant.take(gear_order(plant, 1, task)));
  plant.ids = 3;
  ASSERT_TRUE(plant.take(jog(plant, 0.7)));
  for (int beat = 0; beat < 3000; ++beat) {
    plant.step();
    ASSERT_LE(plant.last[1].commanded.position, 0.8 * (1 + 1e-9)) << beat;
  }

  EXPECT_EQ(plant.last[1].state, AxisState::standing);
  EXPECT_EQ(plant.last[1].stop.cause, StopCause::end_of_range);
  EXPECT_GT(plant.last[1].commanded.position, 0.79);
}

TEST(AxisGears, AFaultOfTheLeaderStopsTheAxisAlongItsLimits) {
  Plant plant{2};
  plant.step();
  ASSERT_TRUE(plant.take(jog(plant, 0.6)));
  plant.ids = 2;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, behind_axis(1.0))));
  plant.steps(1500);
  plant.inputs[0].condition = AxisCondition::fault;
  plant.steps(1000);

  EXPECT_EQ(plant.last[1].state, AxisState::standing);
  EXPECT_EQ(plant.last[1].stop.cause, StopCause::leader_lost);
}

TEST(AxisGears, BeginsOnlyWhereAStopAlongItsOwnLimitsIsPossible) {
  Plant plant{2};
  plant.step();
  ASSERT_TRUE(plant.take(jog(plant, 0.9)));
  plant.steps(100);
  const auto outcome = [&](const GearTask& task, double acceleration, double jerk) {
    ++plant.ids;
    MotionOrder gear = gear_order(plant, 0, task);
    gear.stop.max_acceleration = acceleration;
    gear.stop.min_acceleration = -acceleration;
    gear.stop.jerk = jerk;
    EXPECT_TRUE(plant.take(gear));
    plant.steps(1);
    return plant.ended[0].outcome;
  };
  GearTask task{.kind = LeaderKind::commanded, .leader_axis = 1};
  plant.steps(1000);
  EXPECT_EQ(outcome(task, 1e-6, 50.0), Outcome::no_stop) << "it would stop too late";
  task.range = {.min = -10.0, .max = plant.last[0].commanded.position + 1.0};
  EXPECT_EQ(outcome(task, 0.1, 50.0), Outcome::no_stop) << "it would leave its range";
  EXPECT_EQ(plant.last[0].running, 1U) << "the jog goes on";
  EXPECT_EQ(outcome(task, 5.0, 50.0), Outcome::replaced) << "the jog is replaced";
}

TEST(AxisGears, UsesAsMuchOfTheJerkOfTheMotionBeforeAsItNeeds) {
  Plant plant{2};
  plant.step();
  ASSERT_TRUE(plant.take(jog(plant, 1.0)));
  while (plant.last[0].commanded.velocity < 0.8) plant.step();
  ASSERT_GT(plant.last[0].commanded.acceleration, 1.0);
  plant.ids = 2;
  MotionOrder gear = gear_order(plant, 0, {.kind = LeaderKind::commanded, .leader_axis = 1});
  gear.stop.jerk = 1.0;
  ASSERT_TRUE(plant.take(gear));
  plant.step();
  EXPECT_EQ(plant.last[0].running, 2U);
  plant.steps(2000);  // the plant checks whether the axis becomes too fast
  EXPECT_NEAR(plant.last[0].commanded.velocity, 0.0, 1e-3);
}

/// From one frame to the next, an axis moves at most as far as its velocity limit allows in one
/// period.
TEST(AxisGears, WaitsForASetPointThatWasNotSent) {
  Plant plant{2};
  plant.step();
  ASSERT_TRUE(plant.take(jog(plant, 0.6)));
  ++plant.ids;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, behind_axis(1.0))));
  plant.steps(1000);
  ASSERT_EQ(plant.last[1].gear, GearPhase::locked);
  const double before = plant.last[1].commanded.position;
  plant.inputs[1].is_unsent = true;
  plant.step();
  EXPECT_EQ(plant.last[1].commanded.position, before);
  plant.inputs[1].is_unsent = false;
  plant.step();
  EXPECT_LE(plant.last[1].commanded.position - before, Plant::limits.max_velocity * period);
  plant.steps(2000);
  EXPECT_EQ(plant.last[1].gear, GearPhase::locked);
}

TEST(AxisGears, ARingOfGearsStopsAtOnce) {
  Plant plant{2};
  plant.step();
  plant.ids = 2;
  GearTask other = behind_axis(1.0);
  other.leader_axis = 1;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, behind_axis(1.0))));
  plant.ids = 3;
  ASSERT_TRUE(plant.take(gear_order(plant, 0, other)));
  plant.steps(5);

  EXPECT_EQ(plant.last[0].stop.cause, StopCause::leader_lost);
  EXPECT_EQ(plant.last[1].stop.cause, StopCause::leader_lost);
}

TEST(AxisGears, AReleasedGearIsNoPartOfARing) {
  Plant plant{2};
  plant.step();
  plant.ids = 2;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, behind_axis(1.0))));
  plant.steps(5);
  plant.motions.release_gear(1);
  plant.steps(1);
  plant.ids = 3;
  ASSERT_TRUE(plant.take(gear_order(plant, 0, {.kind = LeaderKind::commanded, .leader_axis = 1})));
  plant.steps(3);
  EXPECT_EQ(plant.last[0].state, AxisState::moving);
  EXPECT_EQ(plant.last[1].gear, GearPhase::released);
}

TEST(AxisGears, AGearFollowsAGearInTheSameCycle) {
  Plant plant{3};
  plant.step();
  plant.ids = 2;
  GearTask last = behind_axis(1.0);
  last.leader_axis = 2;
  GearTask middle = behind_axis(1.0);
  ASSERT_TRUE(plant.take(gear_order(plant, 1, last)));
  plant.ids = 3;
  ASSERT_TRUE(plant.take(gear_order(plant, 2, middle)));
  plant.ids = 4;
  ASSERT_TRUE(plant.take(jog(plant, 0.5)));
  plant.steps(2000);

  EXPECT_NEAR(plant.last[1].commanded.position, plant.last[0].commanded.position, 1e-7);
}

TEST(AxisGears, AReleasedAxisKeepsItsVelocityForTheNextMotion) {
  Plant plant{2};
  plant.step();
  ASSERT_TRUE(plant.take(jog(plant, 0.6)));
  plant.ids = 2;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, behind_axis(1.0))));
  plant.steps(1500);
  plant.motions.release_gear(1);
  plant.steps(3);
  EXPECT_EQ(plant.last[1].gear, GearPhase::released);
  plant.ids = 3;
  MotionOrder move = plant.order(1, {.position = plant.last[1].commanded.position + 1.0}, 1);
  move.from = advanced(plant.last[1].commanded, period, 0.0);
  move.profile = Plant::plan(move.from, {.position = plant.last[1].commanded.position + 1.0});
  ASSERT_TRUE(plant.take(move));
  plant.step();

  EXPECT_EQ(plant.last[1].running, 3U);
  EXPECT_EQ(plant.ended[1].outcome, Outcome::replaced);
}

/// A released axis waits for its frame, too, and the next motion begins where it is then.
TEST(AxisGears, AReleasedAxisWaitsForASetPointThatWasNotSent) {
  Plant plant{2};
  plant.step();
  ASSERT_TRUE(plant.take(jog(plant, 0.6)));
  plant.ids = 2;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, behind_axis(1.0))));
  plant.steps(1500);
  plant.motions.release_gear(1);
  plant.step();
  const State before = plant.last[1].commanded;
  ASSERT_NEAR(before.velocity, 0.6, 1e-6);
  plant.ids = 3;
  MotionOrder move = plant.order(1, before, 1);
  move.from = before;
  move.profile = Plant::plan(before, {.position = before.position + 1.0});
  ASSERT_TRUE(plant.take(move));
  plant.inputs[1].is_unsent = true;
  plant.step();
  EXPECT_EQ(plant.ended[1].outcome, Outcome::replaced);
  EXPECT_EQ(plant.last[1].running, 3U);
  EXPECT_EQ(plant.last[1].commanded.position, before.position);
  plant.inputs[1].is_unsent = false;
  plant.step();
  EXPECT_NEAR(plant.last[1].commanded.position, before.position + 0.6 * period, 1e-7);

  plant.motions.stop_axis(1, StopCause::application);
  plant.steps(1000);
  plant.ids = 4;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, behind_axis(1.0))));
  plant.steps(1500);
  plant.motions.release_gear(1);
  plant.step();
  const double released = plant.last[1].commanded.position;
  plant.inputs[1].is_unsent = true;
  plant.step();
  EXPECT_EQ(plant.last[1].commanded.position, released);
}

TEST(AxisGears, AReleasedAxisWithoutANextMotionStops) {
  Plant plant{2};
  plant.step();
  ASSERT_TRUE(plant.take(jog(plant, 0.6)));
  plant.ids = 2;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, behind_axis(1.0))));
  plant.steps(1500);
  plant.motions.release_gear(1);
  plant.steps(1000);

  EXPECT_EQ(plant.last[1].state, AxisState::standing);
}

TEST(AxisGears, AGearThatIsNotFiniteIsRefused) {
  Plant plant{2};
  plant.step();
  plant.ids = 2;
  EXPECT_FALSE(plant.take(gear_order(plant, 1, behind_axis(std::nan("")))));
  GearTask task = behind_axis(1.0);
  task.bits = 0;
  EXPECT_FALSE(plant.take(gear_order(plant, 1, task)));
}

}  // namespace
}  // namespace takt::motion
