#include "master/lcm/rate_limit.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

using std::chrono::milliseconds;

TEST(RateLimit, ReportsOnceAndThenCounts) {
  RateLimit limit{milliseconds{1000}};

  EXPECT_EQ(limit.allow("a", milliseconds{5000}), 0U);
  EXPECT_EQ(limit.allow("a", milliseconds{5500}), std::nullopt);
  EXPECT_EQ(limit.allow("a", milliseconds{5999}), std::nullopt);
  EXPECT_EQ(limit.allow("b", milliseconds{5999}), 0U);
  EXPECT_EQ(limit.allow("a", milliseconds{6000}), 2U);
}

TEST(RateLimit, AFloodOfDifferentThingsIsHeldBackToo) {
  RateLimit limit{milliseconds{1000}, 4};
  int reported = 0;

  for (int i = 0; i < 1000; ++i) {
    if (limit.allow(std::to_string(i), milliseconds{5000 + i})) ++reported;
  }

  EXPECT_EQ(reported, 4);
}

}  // namespace
}  // namespace takt
