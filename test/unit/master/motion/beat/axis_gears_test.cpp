#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "master/core/kept_state.hpp"
#include "test/unit/master/motion/beat/plant.hpp"

namespace takt::motion {
namespace {

using test::Plant;

constexpr double period = Plant::period;

MotionOrder gear_order(const Plant& plant, std::uint8_t axis, const GearTask& task) {
  return {.id = plant.ids,
          .axis = axis,
          .group = axis,
          .ending = Ending::gear,
          .begin = plant.cycle + 1,
          .from = {},
          .profile = {},
          .gear = task,
          .stop = Plant::limits,
          .timeout = 1'000'000};
}

/// Axis 1 follows axis 0.
GearTask behind_axis(double ratio) {
  return {.kind = LeaderKind::commanded, .leader_axis = 0, .ratio = ratio};
}

MotionOrder jog(const Plant& plant, double velocity) {
  MotionOrder order = plant.order(0, plant.last[0].commanded, 1);
  order.profile = Plant::plan(order.from, {.velocity = velocity}, Goal::velocity);
  order.ending = Ending::cruise;
  order.timeout = 1'000'000;
  return order;
}

/// An encoder with this counter, as the leader of axis 0.
class Encoder {
 public:
  Encoder(Plant& plant, unsigned bits) : plant_{plant}, bits_{bits} {}

  GearTask task(double scale) const {
    return {.kind = LeaderKind::measured,
            .signal = 7,
            .bits = static_cast<std::uint8_t>(bits_),
            .scale = scale,
            .filter_time = 0.02,
            .ratio = 1.0};
  }
  void show(double counts) {
    const auto raw = static_cast<std::int64_t>(std::floor(counts));
    const std::int64_t mask = (std::int64_t{1} << bits_) - 1;
    plant_.inputs[0].leader = {.age = LeaderSample::Age::fresh, .counts = raw & mask};
  }
  void miss() { plant_.inputs[0].leader.age = LeaderSample::Age::missing; }

 private:
  Plant& plant_;
  unsigned bits_;
};

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

/// The coordinates of the leader jump at the end of its homing run, although it stands then.
TEST(AxisGears, AHomingRunOfAMeasuredLeaderStopsTheAxis) {
  Plant plant{2};
  plant.step();
  Encoder encoder{plant, 32};
  GearTask task = encoder.task(0.001);
  task.leader_axis = 1;
  ASSERT_TRUE(plant.take(gear_order(plant, 0, task)));
  for (int beat = 0; beat < 100; ++beat) {
    encoder.show(beat);
    plant.step();
  }
  ASSERT_EQ(plant.last[0].state, AxisState::moving);
  plant.inputs[1].homing = HomingState::runs;
  encoder.show(100);
  plant.step();
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::leader_lost);
}

TEST(AxisGears, BeginsOnlyWhereAStopAlongItsOwnLimitsIsPossible) {
  Plant plant{2};
  plant.step();
  ASSERT_TRUE(plant.take(jog(plant, 0.9)));
  plant.steps(100);
  ASSERT_GT(plant.last[0].commanded.acceleration, 1.0);
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
  EXPECT_EQ(outcome(task, 5.0, 1.0), Outcome::no_stop) << "it would become faster than its limit";
  plant.steps(1000);
  EXPECT_EQ(outcome(task, 1e-6, 50.0), Outcome::no_stop) << "it would stop too late";
  task.range = {.min = -10.0, .max = plant.last[0].commanded.position + 1.0};
  EXPECT_EQ(outcome(task, 0.1, 50.0), Outcome::no_stop) << "it would leave its range";
  EXPECT_EQ(plant.last[0].running, 1U) << "the jog goes on";
  EXPECT_EQ(outcome(task, 5.0, 50.0), Outcome::replaced) << "the jog is replaced";
}

/// From one frame to the next, an axis moves by the way of one period at most.
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

TEST(AxisGears, AnAxisFollowsACoarseNoisyCounterThatWraps) {
  std::mt19937 random{1};
  std::uniform_real_distribution<double> noise{-0.5, 0.5};
  for (const unsigned bits : {12U, 16U, 32U}) {
    Plant plant{1};
    Encoder encoder{plant, bits};
    constexpr double counts = 10'000.0;  // per unit
    const double start = std::exp2(bits) - 1234.5;
    encoder.show(start);
    plant.step();
    plant.ids = 2;
    ASSERT_TRUE(plant.take(gear_order(plant, 0, encoder.task(1 / counts))));
    double error = 0.0;
    for (int beat = 0; beat < 6000; ++beat) {
      encoder.show(start + counts * 0.45 * period * beat + noise(random));
      const double before = plant.last[0].commanded.velocity;
      plant.step();
      if (beat < 3000) continue;
      error = std::max(error, std::abs(plant.last[0].commanded.velocity - 0.45));
      EXPECT_EQ(plant.last[0].gear, GearPhase::locked) << bits << " " << beat;
      EXPECT_LT(std::abs(plant.last[0].commanded.velocity - before), 5.0 * period);
    }
    EXPECT_LT(error, 0.01) << bits;
  }
}

TEST(AxisGears, AModuloOfTheLeaderIsNoJump) {
  Plant plant{1};
  Encoder encoder{plant, 32};
  GearTask task = encoder.task(0.001);
  task.modulo = 3600.0;
  task.lock_window = 0.001;
  task.ratio = -1.0;
  plant.step();
  plant.ids = 2;
  ASSERT_TRUE(plant.take(gear_order(plant, 0, task)));
  for (int beat = 0; beat < 20'000; ++beat) {
    encoder.show(std::fmod(3000.0 + 0.3 * beat, 3600.0));
    plant.step();
    if (beat > 3000) {
      EXPECT_NEAR(plant.last[0].commanded.velocity, -0.3, 0.02);
    }
  }
  EXPECT_EQ(plant.last[0].gear, GearPhase::locked);
}

TEST(AxisGears, AMissingSampleIsBridgedAndThreeStopTheAxis) {
  Plant plant{1};
  Encoder encoder{plant, 32};
  plant.step();
  plant.ids = 2;
  ASSERT_TRUE(plant.take(gear_order(plant, 0, encoder.task(0.0001))));
  for (int beat = 0; beat < 3000; ++beat) {
    encoder.show(3.0 * beat);
    if (beat % 50 < 2) encoder.miss();
    plant.step();
  }
  EXPECT_EQ(plant.last[0].gear, GearPhase::locked);
  EXPECT_NEAR(plant.last[0].commanded.velocity, 0.3, 0.01);

  encoder.miss();
  plant.steps(500);

  EXPECT_EQ(plant.last[0].state, AxisState::standing);
  EXPECT_EQ(plant.last[0].stop.cause, StopCause::leader_lost);
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
