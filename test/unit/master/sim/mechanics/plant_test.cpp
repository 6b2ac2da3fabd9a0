#include "master/sim/mechanics/plant.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <initializer_list>
#include <numbers>

#include "master/sim/random.hpp"

namespace takt::sim {
namespace {

/// Returns an axis without friction.
MechanicsTable smooth() {
  MechanicsTable table;
  table.motor.friction = table.motor.viscosity = 0;
  table.load.friction = table.load.viscosity = 0;
  return table;
}

MechanicsTable elastic(double stiffness) {
  MechanicsTable table = smooth();
  table.load.stiffness = stiffness;
  return table;
}

void run(Plant& plant, int ticks, double torque, double brake = 0) {
  for (int i = 0; i < ticks; ++i) plant.advance(torque, brake);
}

constexpr int second = 4000;  // ticks

double energy(const MechanicsTable& table, const Plant& plant) {
  const double twist = plant.motor().angle - plant.load().angle;
  const double gap = table.load.backlash / 2;
  const double wound = twist - std::clamp(twist, -gap, gap);
  return (table.motor.inertia * plant.motor().speed * plant.motor().speed +
          table.load.inertia * plant.load().speed * plant.load().speed +
          table.load.stiffness.value_or(0) * wound * wound) /
         2;
}

TEST(Plant, AcceleratesByTorqueOverInertia) {
  Plant plant{smooth()};

  run(plant, second, 0.012);

  EXPECT_NEAR(plant.motor().speed, 100.0, 1e-6);
  EXPECT_NEAR(plant.motor().angle, 50.0, 0.02);
}

TEST(Plant, StandsUntilTheTorqueBreaksItAway) {
  MechanicsTable table;
  table.motor.breakaway = 1.3;
  Plant plant{table};

  run(plant, second, 0.051);  // friction of motor and load: 0.04 N m, at rest 0.052 N m
  EXPECT_EQ(plant.motor().angle, 0);
  EXPECT_TRUE(plant.stands());

  run(plant, second, 0.053);
  EXPECT_GT(plant.motor().speed, 50);
}

TEST(Plant, ComesToRestByItsFrictionAndStaysThere) {
  Plant plant{MechanicsTable{}};
  run(plant, second / 10, 1.0);

  run(plant, 10 * second, 0);
  const double angle = plant.motor().angle;
  EXPECT_TRUE(plant.stands());

  run(plant, second, 0);
  EXPECT_EQ(plant.motor().angle, angle);
}

TEST(Plant, SwingsWithTheFrequencyOfItsCoupling) {
  const MechanicsTable table = elastic(20);
  Plant plant{table};
  plant.advance(3, 0);
  int periods = 0;
  double before = 0;
  for (int i = 0; i < second; ++i) {
    plant.advance(0, 0);
    const double twist = plant.motor().angle - plant.load().angle;
    periods += before <= 0 && twist > 0;
    before = twist;
  }

  EXPECT_NEAR(periods, stiffest_mode(table) / (2 * std::numbers::pi), 2);
}

TEST(Plant, TurnsTheLoadOnlyAfterTheBacklash) {
  MechanicsTable table = elastic(20);
  table.load.backlash = 0.01;
  table.load.damping = 0.002;
  Plant plant{table};

  while (plant.motor().angle < 0.0049) plant.advance(0.01, 0);
  EXPECT_EQ(plant.load().angle, 0);

  run(plant, second / 10, 0.01);
  EXPECT_GT(plant.load().angle, 0.0049);
  run(plant, 1, -0.2);
  const double turned = plant.load().angle;
  run(plant, 5, -0.2);
  EXPECT_GE(plant.load().angle, turned) << "the faces don't pull";
}

TEST(Plant, IsHeldByItsBrakeAndFallsWithoutIt) {
  MechanicsTable table;
  table.load.torque = -0.5;
  Plant plant{table};

  run(plant, second, 0, 2.0);
  EXPECT_EQ(plant.motor().angle, 0);
  run(plant, second, 0);
  EXPECT_LT(plant.motor().angle, -1000);
}

TEST(Plant, EndsAtItsStops) {
  Plant plant{smooth()};
  plant.set_stops(-1, 2);

  run(plant, second, 0.1);
  EXPECT_EQ(plant.motor().angle, 2);
  EXPECT_EQ(plant.motor().speed, 0);
  run(plant, second, -0.1);
  EXPECT_EQ(plant.motor().angle, -1);
}

// The reader of the network file accepts any coupling that needs at most most_mechanics_steps, and
// any damping. Without torque, no such axis gains energy.

TEST(Plant, IsStableForAllParametersThatAreAccepted) {
  Random random{5};
  const auto draw = [&random](double low, double high) {
    const double part = random.below(1'000'000) / 1e6;
    return low * std::pow(high / low, part);
  };
  int elastic_axes = 0;
  for (int i = 0; i < 3000; ++i) {
    MechanicsTable table;
    table.motor.inertia = draw(1e-7, 100);
    table.load.inertia = draw(1e-7, 1000);
    table.load.stiffness = draw(1e-3, 1e9);
    table.motor.friction = table.load.friction = 0;
    table.motor.viscosity = draw(1e-9, 100);
    table.load.viscosity = draw(1e-9, 100);
    table.load.damping = i % 3 == 0 ? 0 : draw(1e-6, 1e6);
    table.load.backlash = i % 2 == 0 ? 0 : draw(1e-6, 1);
    if (mechanics_steps(table) > most_mechanics_steps) continue;
    ++elastic_axes;
    Plant plant{table};
    run(plant, 4, 1.0);
    const double given = energy(table, plant);
    for (int step = 0; step < 4000; ++step) {
      plant.advance(0, 0);
      // With semi-implicit steps, the energy oscillates around its mean by the angle of the step.
      ASSERT_LE(energy(table, plant), 2 * given + 1e-12) << i << " after " << step;
    }
  }
  EXPECT_GT(elastic_axes, 300);
}

}  // namespace
}  // namespace takt::sim
