#include "apps/move/move_sizes.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST(MoveSizes, FitTheUnitOfTheAxis) {
  const MoveOptions defaults;
  EXPECT_EQ(sizes_for(defaults, "rad").distance, 1.5);
  EXPECT_EQ(sizes_for(defaults, "m").distance, 0.1);
  EXPECT_EQ(sizes_for(defaults, "").distance, 10000.0);
  EXPECT_LT(sizes_for(defaults, "m").limits.velocity, 0.1);
}

}  // namespace
}  // namespace takt
