// Gears whose leader is a position in the image.
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "test/unit/master/motion/beat/gears.hpp"

namespace takt::motion {
namespace {

using test::Encoder;
using test::gear_order;
using test::Plant;

constexpr double period = Plant::period;

/// The coordinates of the leader jump at the end of its homing run, although it does not move then.
TEST(MeasuredGears, AHomingRunOfAMeasuredLeaderStopsTheAxis) {
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

/// An order for another leader is refused in the cycle in which it is due. The running gear needs
/// the sample of its own leader, but the new gear would need the sample of the other leader.
TEST(MeasuredGears, AnOrderThatIsRefusedDoesNotTakeTheSampleOfTheGearThatRuns) {
  Plant plant{1};
  Encoder encoder{plant, 32};
  GearTask task = encoder.task(1e-3);
  plant.step();
  plant.ids = 2;
  ASSERT_TRUE(plant.take(gear_order(plant, 0, task)));
  for (int beat = 0; beat < 500; ++beat) {
    encoder.show(0.3 * beat);
    plant.step();
  }
  const double velocity = plant.last[0].commanded.velocity;
  plant.ids = 3;
  task.signal = 8;
  MotionOrder other = gear_order(plant, 0, task);
  other.axes = 2;  // the order of the second axis is missing
  ASSERT_TRUE(plant.take(other));
  const LeaderSignals signals = plant.motions.leader_signals(0, plant.cycle + 1);
  EXPECT_EQ(signals[0], 7);
  EXPECT_EQ(signals[1], 8);
  encoder.show(0.3 * 500);
  plant.inputs[0].leaders[1] = {
      .signal = 8, .age = LeaderSample::Age::fresh, .counts = 1'000'000'000};
  plant.step();
  EXPECT_EQ(plant.ended[0].outcome, Outcome::group_incomplete);
  for (int beat = 501; beat < 600; ++beat) {
    encoder.show(0.3 * beat);
    plant.step();
    EXPECT_NEAR(plant.last[0].commanded.velocity, velocity, 0.02) << beat;
  }
  plant.ids = 4;
  ASSERT_TRUE(plant.take(gear_order(plant, 0, task)));
  encoder.show(0.3 * 600);
  plant.step();
  EXPECT_EQ(plant.last[0].running, 4U);
  EXPECT_EQ(plant.last[0].state, AxisState::moving) << "it has the sample of its new leader";
}

/// The leader has moved for two periods, and the axis for one. The axis soon catches up with the
/// leader, although the filter is slow.
TEST(MeasuredGears, AMissingSyncDoesNotDisturbTheEstimateOfAMeasuredLeader) {
  Plant plant{1};
  Encoder encoder{plant, 32};
  GearTask task = encoder.task(1e-6);
  task.filter_time = 0.2;
  plant.step();
  plant.ids = 2;
  ASSERT_TRUE(plant.take(gear_order(plant, 0, task)));
  const auto error = [&] {
    encoder.show(300.0 * static_cast<double>(plant.cycle));
    plant.step();
    return plant.last[0].commanded.position - 0.3 * period * static_cast<double>(plant.cycle);
  };
  for (int beat = 0; beat < 1000; ++beat) error();
  const double before = error();
  ++plant.cycle;
  EXPECT_NEAR(error(), before - 0.3 * period, 1e-6);
  for (int beat = 0; beat < 150; ++beat) error();
  EXPECT_NEAR(error(), before, 1e-6);
}

/// Each axis would follow its own movement.
TEST(MeasuredGears, ARingOfMeasuredPositionsStopsAtOnce) {
  Plant plant{2};
  plant.step();
  const auto task = [&](std::uint8_t leader) {
    return GearTask{.kind = LeaderKind::measured, .leader_axis = leader, .signal = leader};
  };
  for (std::uint16_t axis = 0; axis < 2; ++axis) {
    plant.inputs[axis].leaders[0] = {.signal = static_cast<std::uint16_t>(1 - axis),
                                     .age = LeaderSample::Age::fresh};
  }
  plant.ids = 2;
  ASSERT_TRUE(plant.take(gear_order(plant, 1, task(0))));
  plant.steps(5);
  ASSERT_EQ(plant.last[1].state, AxisState::moving);
  plant.ids = 3;
  ASSERT_TRUE(plant.take(gear_order(plant, 0, task(1))));
  plant.steps(5);

  EXPECT_EQ(plant.last[0].stop.cause, StopCause::leader_lost);
  EXPECT_EQ(plant.last[1].stop.cause, StopCause::leader_lost);
}

TEST(MeasuredGears, AnAxisFollowsACoarseNoisyCounterThatWraps) {
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

TEST(MeasuredGears, AModuloOfTheLeaderIsNoJump) {
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

TEST(MeasuredGears, AMissingSampleIsBridgedAndThreeStopTheAxis) {
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

}  // namespace
}  // namespace takt::motion
