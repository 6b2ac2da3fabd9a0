#include "apps/move/jerk_limited.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "apps/move/synchronised_move.hpp"

namespace takt {
namespace {

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
  const JerkLimited profile{distance, limits};
  const double step = profile.duration() / 10000.0;
  MotionPoint last = profile.at(0.0);

  for (int i = 1; i <= 10000; ++i) {
    const MotionPoint point = profile.at(step * i);
    ASSERT_LE(std::abs(point.velocity), limits.velocity * (1 + 1e-9)) << what << " step " << i;
    ASSERT_LE(std::abs(point.acceleration), limits.acceleration * (1 + 1e-9)) << what;
    const double jerk = (point.acceleration - last.acceleration) / step;
    ASSERT_LE(std::abs(jerk), limits.jerk * (1 + 1e-6)) << what << " step " << i;
    ASSERT_GE(point.position, last.position) << what << " step " << i;
    last = point;
  }
}

TEST_P(AnyMotion, EndsExactlyAtRestAtItsDistance) {
  const auto& [what, distance, limits] = GetParam();
  const JerkLimited profile{distance, limits};
  const MotionPoint end = profile.at(profile.duration());

  EXPECT_EQ(end.position, distance) << what;
  EXPECT_EQ(end.velocity, 0.0);
  EXPECT_EQ(profile.at(profile.duration() + 1.0).position, distance);
  const MotionPoint middle = profile.at(profile.duration() / 2.0);
  EXPECT_NEAR(middle.position, distance / 2.0, distance * 1e-9) << what;
}

TEST_P(AnyMotion, IsSymmetric) {
  const auto& [what, distance, limits] = GetParam();
  const JerkLimited profile{distance, limits};

  for (const double part : {0.1, 0.2, 0.3, 0.4, 0.49}) {
    const MotionPoint early = profile.at(profile.duration() * part);
    const MotionPoint late = profile.at(profile.duration() * (1.0 - part));
    EXPECT_NEAR(early.position, distance - late.position, distance * 1e-9) << what;
    EXPECT_NEAR(early.velocity, late.velocity, limits.velocity * 1e-9) << what;
  }
}

TEST_P(AnyMotion, HasTheVelocityThatItsPositionsShow) {
  const auto& [what, distance, limits] = GetParam();
  const JerkLimited profile{distance, limits};
  const double step = profile.duration() / 1000.0;

  for (int i = 1; i < 1000; ++i) {
    const double shown =
        (profile.at(step * (i + 0.01)).position - profile.at(step * (i - 0.01)).position) /
        (0.02 * step);
    ASSERT_NEAR(shown, profile.at(step * i).velocity, limits.velocity * 1e-3) << what << " " << i;
  }
}

// Calculated by hand: the ramps take 2/4 + 4/20 = 0.7 s each and cover 2 * 0.7 = 1.4 together; the
// cruise takes 8.6 / 2 = 4.3 s.
TEST(JerkLimited, TakesTheShortestTime) {
  EXPECT_DOUBLE_EQ((JerkLimited{10.0, {2.0, 4.0, 20.0}}.duration()), 5.7);
}

// The move has four segments of cbrt(0.02 / (2 * 1.25)) = 0.2 s.
TEST(JerkLimited, IsFourSegmentsWhenShort) {
  EXPECT_DOUBLE_EQ((JerkLimited{0.02, {2.0, 4.0, 1.25}}.duration()), 0.8);
}

TEST(JerkLimited, NeedsNoTimeForNoDistance) {
  const JerkLimited profile{0.0, {1.0, 1.0, 1.0}};
  EXPECT_EQ(profile.duration(), 0.0);
  EXPECT_EQ(profile.at(0.0).position, 0.0);
}

TEST(SynchronisedMove, BringsAllAxesToTheirTargetsTogether) {
  const Eigen::Vector3d from{0.0, 1.0, -2.0};
  const Eigen::Vector3d to{10.0, -1.0, -2.0};
  const std::vector<MotionLimits> limits(3, {2.0, 4.0, 20.0});
  const SynchronisedMove move{from, to, limits};

  EXPECT_DOUBLE_EQ(move.duration(), 5.7);
  EXPECT_EQ(move.position(5.7), to);
  EXPECT_EQ(move.position(-1.0), from);
  const Eigen::VectorXd middle = move.position(2.85);
  EXPECT_NEAR(middle(0), 5.0, 1e-9);
  EXPECT_NEAR(middle(1), 0.0, 1e-9);
  EXPECT_EQ(middle(2), -2.0);
  EXPECT_NEAR(move.velocity(2.85)(1), -0.4, 1e-9);
}

// The second axis moves by 0.2: the ramps take 0.04/0.08 + 0.08/0.4 = 0.7 s, the cruise 0.172/0.04
// = 4.3 s.
TEST(SynchronisedMove, KeepsEachAxisWithinItsOwnLimits) {
  const Eigen::Vector2d from{0.0, 0.0};
  const Eigen::Vector2d to{1.0, -0.2};
  const std::vector<MotionLimits> limits{{1.0, 2.0, 10.0}, {0.04, 0.08, 0.4}};
  const SynchronisedMove move{from, to, limits};

  EXPECT_NEAR(move.duration(), 5.7, 1e-9);
  EXPECT_NEAR(move.velocity(2.85)(1), -0.04, 1e-9);
  EXPECT_NEAR(move.velocity(2.85)(0), 0.2, 1e-9);
}

TEST(SynchronisedMove, MayStandStill) {
  const Eigen::Vector2d here{1.0, 2.0};
  const std::vector<MotionLimits> limits(2, {1.0, 1.0, 1.0});
  EXPECT_EQ((SynchronisedMove{here, here, limits}.position(0.0)), here);
}

}  // namespace
}  // namespace takt
