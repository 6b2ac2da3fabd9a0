#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <tuple>

#include "apps/move/set_points/paced_motion.hpp"
#include "apps/move/set_points/sine.hpp"

namespace takt {
namespace {

TEST(Pace, RunsWithTheClockWhileNothingHoldsIt) {
  Pace pace{0.1};
  for (int i = 0; i < 100; ++i) pace.step(0.002, Hold::no);
  EXPECT_NEAR(pace.time(), 0.2, 1e-12);
}

TEST(Pace, ComesToRestInItsRampAndStaysThere) {
  Pace pace{0.1};
  for (int i = 0; i < 50; ++i) pace.step(0.002, Hold::yes);
  EXPECT_TRUE(pace.standing());
  EXPECT_NEAR(pace.time(), 0.05, 1e-12);
  EXPECT_EQ(pace.step(1.0, Hold::yes), pace.time());
  EXPECT_NEAR(pace.time(), 0.05, 1e-12);
}

TEST(Pace, OneLongStepComesAsFarAsManyShortOnes) {
  Pace pace{0.2};
  EXPECT_NEAR(pace.step(0.5, Hold::yes), 0.1, 1e-12);
  EXPECT_TRUE(pace.standing());
  EXPECT_NEAR(pace.step(0.5, Hold::no), 0.1 + 0.1 + 0.3, 1e-12);
  EXPECT_EQ(pace.rate(), 1.0);
}

TEST(Pace, NeverRunsBackwardsNorFasterThanTheClock) {
  Pace pace{0.1};
  double last = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double now = pace.step(0.002, i % 7 < 3 ? Hold::yes : Hold::no);
    ASSERT_GE(now, last);
    ASSERT_LE(now, last + 0.002 + 1e-12);
    last = now;
  }
}

TEST(Pace, GoesNoFartherThanTheLatestTime) {
  Pace pace{0.1};
  EXPECT_NEAR(pace.step(0.010, Hold::no, 0.004), 0.004, 1e-12);
  EXPECT_NEAR(pace.rate(), 0.4, 1e-12);
  EXPECT_NEAR(pace.step(0.010, Hold::no, 0.004), 0.004, 1e-12);
  EXPECT_TRUE(pace.standing());
  EXPECT_NEAR(pace.step(0.010, Hold::no, 0.001), 0.004, 1e-12) << "it never runs backwards";
}

TEST(Pace, GoesOnInItsRampFromTheLatestTime) {
  Pace pace{0.1};
  pace.step(0.010, Hold::no, 0.0);
  EXPECT_TRUE(pace.standing());
  EXPECT_NEAR(pace.step(0.010, Hold::no, 1.0), 0.0005, 1e-12);
  for (int i = 0; i < 10; ++i) pace.step(0.010, Hold::no, 1.0);
  EXPECT_EQ(pace.rate(), 1.0);
}

TEST(Pace, TakesAStepOfNoTimeBehindTheLatest) {
  Pace pace{0.1};
  pace.step(0.010, Hold::no);
  EXPECT_NEAR(pace.step(0.0, Hold::no, 0.005), 0.010, 1e-12);
  EXPECT_TRUE(pace.standing());
}

TEST(Sine, StartsAndEndsAtRestAtItsCentre) {
  const Eigen::Vector2d centre{1.0, -1.0};
  const Sine sine{centre,
                  {.amplitude = centre.cwiseAbs() / 2.0, .frequency = 0.5, .duration = 8.0}};

  EXPECT_EQ(sine.position(0.0), centre);
  EXPECT_TRUE(sine.position(8.0).isApprox(centre, 1e-12));
  EXPECT_LT((sine.position(0.001) - centre).norm(), 1e-6);
  EXPECT_LT((sine.position(7.999) - centre).norm(), 1e-6);
}

TEST(Sine, SwingsByItsAmplitudeAndNoFarther) {
  const Sine sine{
      Eigen::VectorXd::Zero(3),
      {.amplitude = Eigen::VectorXd::Constant(3, 0.5), .frequency = 0.5, .duration = 8.0}};
  double farthest = 0.0;
  for (int i = 0; i <= 8000; ++i) {
    farthest = std::max(farthest, sine.position(i * 0.001).cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(farthest, 0.5, 1e-3);
}

TEST(Sine, SwingsEachAxisByItsOwnAmplitude) {
  const Sine sine{Eigen::VectorXd::Zero(2),
                  {.amplitude = Eigen::Vector2d{0.375, 0.025}, .frequency = 0.5, .duration = 8.0}};
  Eigen::Vector2d farthest{0.0, 0.0};
  for (int i = 0; i <= 8000; ++i) {
    farthest = farthest.cwiseMax(sine.position(i * 0.001).cwiseAbs());
  }
  EXPECT_NEAR(farthest(0), 0.375, 1e-3);
  EXPECT_NEAR(farthest(1), 0.025, 1e-4);
}

/// Returns the largest velocity, acceleration and jerk of the first axis, computed by differences.
MotionLimits reached(const Sine& sine) {
  constexpr double step = 1e-3;
  MotionLimits most{.velocity = 0.0, .acceleration = 0.0, .jerk = 0.0};
  const auto at = [&](double seconds) { return sine.position(seconds)(0); };
  for (double t = 2.0 * step; t < sine.duration() - 2.0 * step; t += step) {
    const double before = at(t - step);
    const double here = at(t);
    const double after = at(t + step);
    const double jerk =
        (at(t + 2.0 * step) - 2.0 * after + 2.0 * before - at(t - 2.0 * step)) / 2.0;
    most.velocity = std::max(most.velocity, std::abs(after - before) / (2.0 * step));
    most.acceleration =
        std::max(most.acceleration, std::abs(after - 2.0 * here + before) / (step * step));
    most.jerk = std::max(most.jerk, std::abs(jerk) / (step * step * step));
  }
  return most;
}

class SineWithin : public testing::TestWithParam<std::tuple<MotionLimits, double>> {};

TEST_P(SineWithin, KeepsToTheLimitsAlsoWhileItFades) {
  const auto& [limits, duration] = GetParam();
  Sine sine{Eigen::VectorXd::Zero(1),
            {.amplitude = Eigen::VectorXd::Ones(1), .frequency = 0.5, .duration = duration}};
  sine.set_amplitude(0, sine.amplitude_within(limits));

  const MotionLimits most = reached(sine);
  EXPECT_LE(most.velocity, limits.velocity * 1.001);
  EXPECT_LE(most.acceleration, limits.acceleration * 1.001);
  EXPECT_LE(most.jerk, limits.jerk * 1.001);
}

INSTANTIATE_TEST_SUITE_P(LimitsAndDurations, SineWithin,
                         testing::Combine(testing::Values(MotionLimits{0.5, 100.0, 1000.0},
                                                          MotionLimits{100.0, 1.0, 1000.0},
                                                          MotionLimits{100.0, 100.0, 3.0}),
                                          testing::Values(2.0, 3.0, 9.0)));

// The velocity limit is 2 pi rad/s, which the full amplitude reaches exactly.
TEST(Sine, SwingsAsFarAsItsVelocityMay) {
  const Sine sine{Eigen::VectorXd::Zero(1),
                  {.amplitude = Eigen::VectorXd::Ones(1), .frequency = 1.0, .duration = 9.0}};
  EXPECT_NEAR(sine.amplitude_within({6.283185307, 1000.0, 1e6}), 1.0, 1e-9);
}

TEST(Sine, LastsAsLongAsAskedFromOnePeriodOn) {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  const Sine sine{Eigen::VectorXd::Zero(1), {.amplitude = one, .frequency = 0.5, .duration = 2.5}};
  EXPECT_DOUBLE_EQ(sine.duration(), 2.5);
  EXPECT_LT(sine.position(0.001).norm(), 1e-6);
  EXPECT_LT(sine.position(2.499).norm(), 1e-6);
}

TEST(Sine, LastsAtLeastOnePeriod) {
  const Sine sine{Eigen::VectorXd::Zero(1),
                  {.amplitude = Eigen::VectorXd::Ones(1), .frequency = 0.5, .duration = 1.0}};
  EXPECT_DOUBLE_EQ(sine.duration(), 2.0);
}

}  // namespace
}  // namespace takt
