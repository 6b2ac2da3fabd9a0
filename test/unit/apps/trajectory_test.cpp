#include <cmath>
#include <gtest/gtest.h>

#include "apps/move/pace.hpp"
#include "apps/move/sine.hpp"

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
  const Sine sine{centre, {.amplitude = 0.5, .frequency = 0.5, .duration = 8.0}};

  EXPECT_EQ(sine.position(0.0), centre);
  EXPECT_TRUE(sine.position(8.0).isApprox(centre, 1e-12));
  EXPECT_LT((sine.position(0.001) - centre).norm(), 1e-6);
  EXPECT_LT((sine.position(7.999) - centre).norm(), 1e-6);
}

TEST(Sine, SwingsByItsAmplitudeAndNoFarther) {
  const Sine sine{Eigen::VectorXd::Zero(3), {.amplitude = 0.5, .frequency = 0.5, .duration = 8.0}};
  double farthest = 0.0;
  for (int i = 0; i <= 8000; ++i) {
    farthest = std::max(farthest, sine.position(i * 0.001).cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(farthest, 0.5, 1e-3);
}

TEST(Sine, LastsAtLeastTwoPeriods) {
  const Sine sine{Eigen::VectorXd::Zero(1), {.amplitude = 1.0, .frequency = 0.5, .duration = 1.0}};
  EXPECT_DOUBLE_EQ(sine.duration(), 4.0);
}

}  // namespace
}  // namespace takt
