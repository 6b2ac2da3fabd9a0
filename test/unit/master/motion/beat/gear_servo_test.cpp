#include "master/motion/beat/gear_servo.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "master/motion/beat/profile_player.hpp"
#include "master/motion/trajectory.hpp"

namespace takt::motion {
namespace {

constexpr double period = 1e-3;
constexpr double rounding = 1e-9;

class Random {
 public:
  double between(double low, double high) {
    return std::uniform_real_distribution{low, high}(generator_);
  }
  double size(double low, double high) { return std::pow(10.0, between(low, high)); }
  Limits limits() {
    const double velocity = size(-1.0, 1.5);
    const double acceleration = velocity * size(0.0, 2.0);
    return {.max_velocity = velocity,
            .min_velocity = -velocity * between(0.5, 1.0),
            .max_acceleration = acceleration,
            .min_acceleration = -acceleration * between(0.5, 1.0),
            .jerk = acceleration * size(0.5, 2.5)};
  }

 private:
  std::mt19937 generator_{1};
};

/// Returns the largest excess over a limit in one step, as a part of this limit. It checks the jerk
/// of the step itself: the third difference of the positions would be a mean of three steps.
double excess(const State& from, const State& to, const Limits& limits) {
  const double jerk = std::abs(to.acceleration - from.acceleration) / period / limits.jerk;
  const State same = advanced(from, period, (to.acceleration - from.acceleration) / period);
  EXPECT_NEAR(to.position, same.position, 1e-12 * std::max(1.0, std::abs(to.position)));
  EXPECT_NEAR(to.velocity, same.velocity, 1e-12 * limits.max_velocity);
  return std::max({to.velocity / limits.max_velocity, to.velocity / limits.min_velocity,
                   to.acceleration / limits.max_acceleration,
                   to.acceleration / limits.min_acceleration, jerk}) -
         1.0;
}

TEST(GearServo, ReachesEachTargetOfConstantVelocityExactlyAndWithoutOvershoot) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const Limits limits = random.limits();
    const GearServo servo{limits};
    const double velocity = random.between(-0.4, 0.9) * limits.max_velocity;
    State axis{.velocity = random.between(-0.4, 0.9) * limits.max_velocity};
    State target{.position = random.between(-1.0, 1.0), .velocity = velocity};
    double worst = -1.0;
    double overshoot = 0.0;
    int locked = 0;
    const double cube = limits.jerk * period * period * period;
    int side = 0;
    int turns = 0;
    for (int cycle = 0; cycle < 60'000 && locked < 20; ++cycle) {
      target = advanced(target, period, 0.0);
      const State next = servo.step_to_position(axis, target, 0.0, period);
      worst = std::max(worst, excess(axis, next, limits));
      axis = next;
      const double error = axis.position - target.position;
      const bool same = std::abs(error) <= rounding * std::max(1.0, std::abs(target.position)) &&
                        std::abs(axis.velocity - velocity) <= rounding * limits.max_velocity;
      locked = same ? locked + 1 : 0;
      if (std::abs(error) <= cube) continue;
      const int now = error > 0.0 ? 1 : -1;
      if (side != 0 && now != side) ++turns;
      if (turns > 1) overshoot = std::max(overshoot, std::abs(error) / cube);
      side = now;
    }
    EXPECT_EQ(locked, 20) << i;
    EXPECT_LE(worst, rounding) << i;
    // It may pass the target once, if it begins so fast that it can't brake before. After that,
    // the error stays within what the limit of jerk changes in a few steps.
    EXPECT_LE(overshoot, 4.0) << i;
  }
}

TEST(GearServo, KeepsItsLimitsBehindAnyTargetAndFollowsOneInsideThem) {
  Random random;
  double farthest = 0.0;
  for (int i = 0; i < 400; ++i) {
    const Limits limits = random.limits();
    const double part = random.between(0.3, 2.0);  // limits of the target by those of the servo
    const GearServo servo{limits};
    const Limits of_target{.max_velocity = part * limits.max_velocity,
                           .min_velocity = part * limits.min_velocity,
                           .max_acceleration = part * limits.max_acceleration,
                           .min_acceleration = part * limits.min_acceleration,
                           .jerk = part * limits.jerk};
    const double cube = limits.jerk * period * period * period;
    State axis{};
    State target{};
    double worst = -1.0;
    for (int move = 0; move < 6; ++move) {
      const double time = limits.max_velocity / limits.max_acceleration;
      const AxisTask task{.from = target,
                          .to = {.position = target.position + random.between(-2.0, 2.0) * time *
                                                                   limits.max_velocity},
                          .limits = of_target};
      PlannedAxis planned;
      const TrajectoryOptions options{};
      ASSERT_TRUE(plan_trajectory({&task, 1}, options, {&planned, 1}));
      ProfilePlayer player{planned.profile, task.from, Ending::rest};
      const int cycles = std::min(static_cast<int>(planned.duration / period) + 200, 20'000);
      for (int cycle = 1; cycle <= cycles; ++cycle) {
        const State before = target;
        target = player.at(cycle * period);
        const double jerk = (target.acceleration - before.acceleration) / period;
        const State next = servo.step_to_position(axis, target, jerk, period);
        worst = std::max(worst, excess(axis, next, limits));
        axis = next;
        if (part < 0.8) {
          farthest = std::max(farthest, std::abs(axis.position - target.position) / cube);
        }
      }
    }
    EXPECT_LE(worst, rounding) << i;
  }
  EXPECT_LE(farthest, 1.0);
}

/// Leader and follower often have the same limits, and a move of the leader uses them completely.
TEST(GearServo, StaysCloseToATargetThatUsesAllItsLimits) {
  const Limits limits{.max_velocity = 3.0,
                      .min_velocity = -2.0,
                      .max_acceleration = 20.0,
                      .min_acceleration = -13.0,
                      .jerk = 400.0};
  const GearServo servo{limits};
  State axis;
  State target;
  double worst = 0.0;
  for (int move = 0; move < 4; ++move) {
    const double way = (move % 2 == 0 ? 1.0 : -1.0) * (2.0 + move * 0.37);
    const AxisTask task{
        .from = target, .to = {.position = target.position + way}, .limits = limits};
    PlannedAxis planned;
    ASSERT_TRUE(plan_trajectory({&task, 1}, {}, {&planned, 1}));
    ProfilePlayer player{planned.profile, task.from, Ending::rest};
    for (int cycle = 1; cycle * period < planned.duration + 0.3; ++cycle) {
      const State before = target;
      target = player.at(cycle * period);
      const double jerk = (target.acceleration - before.acceleration) / period;
      axis = servo.step_to_position(axis, target, jerk, period);
      worst = std::max(worst, std::abs(axis.position - target.position));
    }
    EXPECT_NEAR(axis.position, target.position, rounding);
  }
  EXPECT_LT(worst, 1e-3);
}

TEST(GearServo, MatchesTheVelocityOfItsTargetAlone) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Limits limits = random.limits();
    const GearServo servo{limits};
    const double velocity = random.between(-0.4, 0.9) * limits.max_velocity;
    State axis{.velocity = random.between(-0.4, 0.9) * limits.max_velocity};
    double worst = -1.0;
    const double before = axis.velocity - velocity;
    double overshoot = 0.0;
    for (int cycle = 0; cycle < 20'000; ++cycle) {
      const State next = servo.step_to_velocity(axis, {.velocity = velocity}, period);
      worst = std::max(worst, excess(axis, next, limits));
      axis = next;
      overshoot = std::max(overshoot, (velocity - axis.velocity) * (before > 0.0 ? 1.0 : -1.0));
    }
    EXPECT_LE(worst, rounding) << i;
    EXPECT_LE(overshoot, rounding * limits.max_velocity) << i;
    EXPECT_NEAR(axis.velocity, velocity, rounding * limits.max_velocity) << i;
    EXPECT_NEAR(axis.acceleration, 0.0, rounding * limits.max_acceleration) << i;
  }
}

TEST(GearServo, ReturnsInsideLimitsThatAreLowerThanItsState) {
  const Limits limits{.max_velocity = 1.0,
                      .min_velocity = -1.0,
                      .max_acceleration = 10.0,
                      .min_acceleration = -10.0,
                      .jerk = 200.0};
  const GearServo servo{limits};
  State axis{.velocity = 3.0, .acceleration = 30.0};

  double jerk = 0.0;
  for (int cycle = 1; cycle <= 700; ++cycle) {
    const State next = servo.step_to_position(
        axis, {.position = 0.5 * cycle * period, .velocity = 0.5}, 0.0, period);
    jerk = std::max(jerk, std::abs(next.acceleration - axis.acceleration) / period);
    axis = next;
  }

  EXPECT_LE(jerk, 200.0 * (1 + rounding));
  EXPECT_LE(axis.velocity, 1.0);
}

}  // namespace
}  // namespace takt::motion
