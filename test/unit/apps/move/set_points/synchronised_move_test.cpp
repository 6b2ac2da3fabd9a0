#include "apps/move/set_points/synchronised_move.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace takt {
namespace {

/// Returns the move of one axis from 0.
SynchronisedMove move_to(double target, const MotionLimits& limits) {
  return SynchronisedMove::plan(Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, target),
                                std::vector{limits})
      .value();
}

struct Motion {
  const char* what;
  double distance;
  MotionLimits limits;
};

class AnyMotion : public testing::TestWithParam<Motion> {};

INSTANTIATE_TEST_SUITE_P(
    Shapes, AnyMotion,
    testing::Values(Motion{"all seven segments", 10.0, {2.0, 4.0, 20.0}},
                    Motion{"no cruise", 0.5, {2.0, 4.0, 20.0}},
                    Motion{"acceleration never reached", 0.01, {2.0, 4.0, 20.0}},
                    Motion{"cruise without full acceleration", 10.0, {0.1, 4.0, 20.0}},
                    Motion{"very short", 1e-9, {2.0, 4.0, 20.0}},
                    Motion{"very long", 1e6, {2.0, 4.0, 20.0}}));

TEST_P(AnyMotion, StaysWithinItsLimits) {
  const auto& [what, distance, limits] = GetParam();
  const SynchronisedMove move = move_to(distance, limits);
  const double step = move.duration() / 1000.0;
  double last = 0.0;
  double last_velocity = 0.0;

  for (int i = 1; i <= 1000; ++i) {
    const double position = move.position(step * i)(0);
    const double velocity = (position - last) / step;
    ASSERT_GE(velocity, -1e-9 * limits.velocity) << what << " step " << i;
    ASSERT_LE(velocity, limits.velocity * (1 + 1e-6)) << what << " step " << i;
    ASSERT_LE(std::abs(velocity - last_velocity) / step, limits.acceleration * (1 + 1e-3)) << what;
    last = position;
    last_velocity = velocity;
  }
}

TEST_P(AnyMotion, EndsExactlyAtItsTarget) {
  const auto& [what, distance, limits] = GetParam();
  const SynchronisedMove move = move_to(distance, limits);

  EXPECT_EQ(move.position(move.duration())(0), distance) << what;
  EXPECT_EQ(move.position(move.duration() + 1.0)(0), distance);
  EXPECT_NEAR(move.position(move.duration() * (1.0 - 1e-9))(0), distance, distance * 1e-9) << what;
}

TEST_P(AnyMotion, IsSymmetric) {
  const auto& [what, distance, limits] = GetParam();
  const SynchronisedMove move = move_to(distance, limits);

  for (const double part : {0.1, 0.2, 0.3, 0.4, 0.5}) {
    const double early = move.position(move.duration() * part)(0);
    const double late = move.position(move.duration() * (1.0 - part))(0);
    EXPECT_NEAR(early, distance - late, distance * 1e-9) << what;
  }
}

// Calculated by hand: the ramps take 2/4 + 4/20 = 0.7 s each and cover 2 * 0.7 = 1.4 together; the
// cruise takes 8.6 / 2 = 4.3 s.
TEST(SynchronisedMove, TakesTheShortestTime) {
  EXPECT_NEAR(move_to(10.0, {2.0, 4.0, 20.0}).duration(), 5.7, 1e-12);
}

// The move has four segments of cbrt(0.02 / (2 * 1.25)) = 0.2 s.
TEST(SynchronisedMove, IsFourSegmentsWhenShort) {
  EXPECT_NEAR(move_to(0.02, {2.0, 4.0, 1.25}).duration(), 0.8, 1e-12);
}

TEST(SynchronisedMove, BringsAllAxesToTheirTargetsTogether) {
  const Eigen::Vector3d from{0.0, 1.0, -2.0};
  const Eigen::Vector3d to{10.0, -1.0, -2.0};
  const std::vector<MotionLimits> limits(3, {2.0, 4.0, 20.0});
  const SynchronisedMove move = SynchronisedMove::plan(from, to, limits).value();

  EXPECT_NEAR(move.duration(), 5.7, 1e-12);
  EXPECT_EQ(move.position(5.8), to);
  EXPECT_EQ(move.position(-1.0), from);
  const Eigen::VectorXd quarter = move.position(1.425);
  EXPECT_NEAR((quarter(0) - 0.0) / 10.0, (quarter(1) - 1.0) / -2.0, 1e-12);
  const Eigen::VectorXd middle = move.position(2.85);
  EXPECT_NEAR(middle(0), 5.0, 1e-9);
  EXPECT_NEAR(middle(1), 0.0, 1e-9);
  EXPECT_EQ(middle(2), -2.0);
}

// The second axis moves by 0.2: the ramps take 0.04/0.08 + 0.08/0.4 = 0.7 s, the cruise 0.172/0.04
// = 4.3 s.
TEST(SynchronisedMove, KeepsEachAxisWithinItsOwnLimits) {
  const Eigen::Vector2d from{0.0, 0.0};
  const Eigen::Vector2d to{1.0, -0.2};
  const std::vector<MotionLimits> limits{{1.0, 2.0, 10.0}, {0.04, 0.08, 0.4}};
  const SynchronisedMove move = SynchronisedMove::plan(from, to, limits).value();

  EXPECT_NEAR(move.duration(), 5.7, 1e-9);
  const Eigen::VectorXd velocity = (move.position(2.86) - move.position(2.84)) / 0.02;
  EXPECT_NEAR(velocity(1), -0.04, 1e-9);
  EXPECT_NEAR(velocity(0), 0.2, 1e-9);
}

TEST(SynchronisedMove, MayStandStill) {
  const Eigen::Vector2d here{1.0, 2.0};
  const std::vector<MotionLimits> limits(2, {1.0, 1.0, 1.0});
  const SynchronisedMove move = SynchronisedMove::plan(here, here, limits).value();

  EXPECT_EQ(move.duration(), 0.0);
  EXPECT_EQ(move.position(0.0), here);
}

TEST(SynchronisedMove, IsHalfWayAfterHalfItsTimeAlsoIfItsLimitsAreFarApart) {
  const Eigen::VectorXd from{Eigen::VectorXd::Constant(1, 6.2552561058050875e-09)};
  const Eigen::VectorXd to{Eigen::VectorXd::Constant(1, -3.6551741658825909e-07)};
  const std::vector<MotionLimits> far_apart{{4.22991e+07, 1.85281e-08, 7.53909e+07}};

  const SynchronisedMove move = SynchronisedMove::plan(from, to, far_apart).value();

  EXPECT_NEAR(move.position(move.duration() / 2)(0), (from(0) + to(0)) / 2, 1e-15);
}

TEST(SynchronisedMove, IsRefusedIfItsTargetIsInfinite) {
  const Eigen::VectorXd from{Eigen::VectorXd::Constant(1, 0.0)};
  const Eigen::VectorXd infinite{
      Eigen::VectorXd::Constant(1, std::numeric_limits<double>::infinity())};
  EXPECT_FALSE(SynchronisedMove::plan(from, infinite, std::vector<MotionLimits>(1)));
}

}  // namespace
}  // namespace takt
