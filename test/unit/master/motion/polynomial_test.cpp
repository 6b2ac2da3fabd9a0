#include "master/motion/polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace takt::motion {
namespace {

State state_of(const Polynomial& position, double time) {
  const Polynomial velocity = derivative_of(position);
  return {.position = value_at(position, time),
          .velocity = value_at(velocity, time),
          .acceleration = value_at(derivative_of(velocity), time)};
}

TEST(Polynomial, AQuinticHasBothStatesAndACubicBothPositionsAndVelocities) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> any{-5.0, 5.0};
  for (int i = 0; i < 1000; ++i) {
    const State from{.position = any(random), .velocity = any(random), .acceleration = any(random)};
    const State to{.position = any(random), .velocity = any(random), .acceleration = any(random)};
    const double duration = 0.01 + std::abs(any(random));
    const Polynomial quintic = quintic_between(from, to, duration);
    const State begin = state_of(quintic, 0.0);
    const State end = state_of(quintic, duration);
    EXPECT_DOUBLE_EQ(begin.acceleration, from.acceleration);
    EXPECT_NEAR(end.position, to.position, 1e-9);
    EXPECT_NEAR(end.velocity, to.velocity, 1e-8);
    EXPECT_NEAR(end.acceleration, to.acceleration, 1e-5);
    const State cubic = state_of(cubic_between(from, to, duration), duration);
    EXPECT_NEAR(cubic.position, to.position, 1e-9);
    EXPECT_NEAR(cubic.velocity, to.velocity, 1e-8);
  }
}

/// Compares the extremes with the values at many times. They may exceed these values a little.
TEST(Polynomial, ExtremesContainAllValuesAndAreReached) {
  std::mt19937_64 random{2};
  std::uniform_real_distribution<double> any{-5.0, 5.0};
  for (int i = 0; i < 500; ++i) {
    Polynomial c{};
    for (double& number : c) number = any(random);
    const double duration = 0.1 + std::abs(any(random));
    const Extremes found = extremes_of(c, duration);
    Extremes seen{.min = c[0], .max = c[0]};
    for (int k = 0; k <= 20'000; ++k) {
      const double value = value_at(c, duration * k / 20'000);
      seen.min = std::min(seen.min, value);
      seen.max = std::max(seen.max, value);
    }
    const double size = 1.0 + std::max(-found.min, found.max);
    EXPECT_LE(found.min, seen.min + 1e-12 * size);
    EXPECT_GE(found.max, seen.max - 1e-12 * size);
    EXPECT_NEAR(found.min, seen.min, 1e-6 * size);
    EXPECT_NEAR(found.max, seen.max, 1e-6 * size);
  }
}

TEST(Polynomial, ExtremesOfAConstantAndOfALineAreItsEnds) {
  EXPECT_EQ(extremes_of({3.0}, 2.0).max, 3.0);
  EXPECT_EQ(extremes_of({3.0, -1.0}, 2.0).min, 1.0);
}

}  // namespace
}  // namespace takt::motion
