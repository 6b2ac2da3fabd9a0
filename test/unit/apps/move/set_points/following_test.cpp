#include "apps/move/set_points/following.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

using Vector = Eigen::Vector2d;

TEST(Following, ComparesAPositionWithTheTargetThatActedAtTheSyncBefore) {
  Following following{2};
  following.sent(10, Vector{1.0, 2.0});
  following.sent(11, Vector{9.0, 9.0});
  following.seen(11, Vector{1.25, 1.5});

  EXPECT_DOUBLE_EQ(following.error()(0), 0.25);
  EXPECT_DOUBLE_EQ(following.error()(1), -0.5);
  EXPECT_DOUBLE_EQ(following.largest()(1), 0.5);
  EXPECT_EQ(following.samples(), 1);
}

TEST(Following, LeavesOutPositionsWithoutATarget) {
  Following following{2};
  following.sent(10, Vector{1.0, 2.0});
  following.seen(13, Vector{5.0, 5.0});
  following.seen(1, Vector{5.0, 5.0});
  EXPECT_EQ(following.samples(), 0);
  EXPECT_EQ(following.largest()(0), 0.0);
}

TEST(Following, KeepsTheLargest) {
  Following following{2};
  for (std::int64_t cycle = 0; cycle < 20; ++cycle) {
    following.sent(cycle, Vector{0.0, 0.0});
    following.seen(cycle, Vector{cycle == 7 ? -3.0 : 1.0, 0.0});
  }
  EXPECT_DOUBLE_EQ(following.largest()(0), 3.0);
}

}  // namespace
}  // namespace takt
