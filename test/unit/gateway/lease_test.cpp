#include "master/gateway/lease.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

TEST(Freshness, ShorterOfMessageAndConfigurationCounts) {
  EXPECT_EQ(
      freshness({.computed_from = 100, .now = 100, .time_to_live = 3, .configured = 10}).cycles,
      3U);
  EXPECT_EQ(
      freshness({.computed_from = 100, .now = 100, .time_to_live = 10, .configured = 3}).cycles,
      3U);
  EXPECT_EQ(
      freshness({.computed_from = 100, .now = 100, .time_to_live = 0, .configured = 4}).cycles, 4U);
  EXPECT_EQ(
      freshness({.computed_from = 100, .now = 100, .time_to_live = 5, .configured = 0}).cycles, 5U);
}

TEST(Freshness, WithoutAnyLimitACommandStaysGood) {
  const Freshness left =
      freshness({.computed_from = 1, .now = 1'000'000, .time_to_live = 0, .configured = 0});

  EXPECT_TRUE(left.fresh);
  EXPECT_EQ(left.cycles, 0U);
}

TEST(Freshness, TimeInAQueueIsTimeLived) {
  const Freshness two_late =
      freshness({.computed_from = 98, .now = 100, .time_to_live = 3, .configured = 0});
  EXPECT_TRUE(two_late.fresh);
  EXPECT_EQ(two_late.cycles, 1U);

  EXPECT_FALSE(
      freshness({.computed_from = 97, .now = 100, .time_to_live = 3, .configured = 0}).fresh);
  EXPECT_FALSE(
      freshness({.computed_from = 1, .now = 100, .time_to_live = 3, .configured = 0}).fresh);
}

TEST(Freshness, ACycleFromTheFutureOrUnknownCountsFromNow) {
  EXPECT_EQ(
      freshness({.computed_from = 500, .now = 100, .time_to_live = 3, .configured = 0}).cycles, 3U);
  EXPECT_EQ(freshness({.computed_from = 0, .now = 100, .time_to_live = 3, .configured = 0}).cycles,
            3U);
}

TEST(Lease, FirstSenderHoldsTheNodeUntilItsTimeToLiveHasRunOut) {
  LeaseTable leases{2, 500};

  EXPECT_TRUE(leases.take(0, "move", 100, 3));
  EXPECT_FALSE(leases.take(0, "other", 102, 3));
  EXPECT_EQ(leases.holder(0, 102), "move");
  EXPECT_TRUE(leases.take(0, "other", 103, 3));
  EXPECT_FALSE(leases.take(0, "move", 104, 3));
}

TEST(Lease, EachCommandProlongsIt) {
  LeaseTable leases{1, 500};
  leases.take(0, "move", 100, 3);

  EXPECT_TRUE(leases.take(0, "move", 102, 3));

  EXPECT_FALSE(leases.take(0, "other", 104, 3));
  EXPECT_TRUE(leases.take(0, "other", 105, 3));
}

TEST(Lease, NodesAreHeldSeparately) {
  LeaseTable leases{2, 500};
  leases.take(0, "a", 1, 10);

  EXPECT_TRUE(leases.take(1, "b", 1, 10));
  EXPECT_EQ(leases.holder(0, 2), "a");
  EXPECT_EQ(leases.holder(1, 2), "b");
}

TEST(Lease, WithoutTimeToLiveItEndsAfterTheUnlimitedTime) {
  LeaseTable leases{1, 500};
  leases.take(0, "a", 1000, 0);

  EXPECT_FALSE(leases.take(0, "b", 1499, 0));
  EXPECT_TRUE(leases.take(0, "b", 1500, 0));
}

TEST(Lease, NobodyHoldsANodeThatIsNotThere) {
  LeaseTable leases{1, 500};

  EXPECT_FALSE(leases.take(1, "a", 0, 1));
  EXPECT_EQ(leases.holder(1, 0), "");
}

}  // namespace
}  // namespace takt
