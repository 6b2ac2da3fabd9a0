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
      freshness({.computed_from = 100, .now = 100, .time_to_live = 5, .configured = 0, .most = 500})
          .cycles,
      5U);
}

TEST(Freshness, WithoutAnyLimitACommandStaysGoodOnceItCameWithinASecond) {
  const auto waited = [](std::uint64_t cycles) {
    return freshness({.computed_from = 1000, .now = 1000 + cycles, .most = 500});
  };

  EXPECT_TRUE(waited(499).fresh);
  EXPECT_EQ(waited(499).cycles, 0U) << "no limit from here on";
  EXPECT_FALSE(waited(500).fresh);
}

TEST(Freshness, WithoutAConfiguredLimitAMessageGetsASecondAtMost) {
  const Freshness left = freshness(
      {.computed_from = 100, .now = 100, .time_to_live = 2147483647, .configured = 0, .most = 500});

  EXPECT_EQ(left.cycles, 500U);
}

TEST(Freshness, TimeInAQueueIsTimeLived) {
  const Freshness two_late =
      freshness({.computed_from = 98, .now = 100, .time_to_live = 3, .configured = 0, .most = 500});
  EXPECT_TRUE(two_late.fresh);
  EXPECT_EQ(two_late.cycles, 1U);

  EXPECT_FALSE(
      freshness({.computed_from = 97, .now = 100, .time_to_live = 3, .configured = 0, .most = 500})
          .fresh);
  EXPECT_FALSE(
      freshness({.computed_from = 1, .now = 100, .time_to_live = 3, .configured = 0, .most = 500})
          .fresh);
}

constexpr Sender a_sender{.instance = 1, .name = "a"};
constexpr Sender b_sender{.instance = 2, .name = "b"};

TEST(Lease, FirstSenderHoldsTheNodeUntilItsTimeToLiveHasRunOut) {
  LeaseTable leases{2, 500};

  EXPECT_TRUE(leases.take(0, a_sender, 100, 3));
  EXPECT_FALSE(leases.take(0, b_sender, 102, 3));
  EXPECT_EQ(leases.holder(0, 102), "a");
  EXPECT_TRUE(leases.take(0, b_sender, 103, 3));
  EXPECT_FALSE(leases.take(0, a_sender, 104, 3));
}

TEST(Lease, EachCommandProlongsIt) {
  LeaseTable leases{1, 500};
  leases.take(0, a_sender, 100, 3);

  EXPECT_TRUE(leases.take(0, a_sender, 102, 3));

  EXPECT_FALSE(leases.take(0, b_sender, 104, 3));
  EXPECT_TRUE(leases.take(0, b_sender, 105, 3));
}

TEST(Lease, NodesAreHeldSeparately) {
  LeaseTable leases{2, 500};
  leases.take(0, a_sender, 1, 10);

  EXPECT_TRUE(leases.take(1, b_sender, 1, 10));
  EXPECT_EQ(leases.holder(0, 2), "a");
  EXPECT_EQ(leases.holder(1, 2), "b");
}

TEST(Lease, WithoutTimeToLiveItEndsAfterTheUnlimitedTime) {
  LeaseTable leases{1, 500};
  leases.take(0, a_sender, 1000, 0);

  EXPECT_FALSE(leases.take(0, b_sender, 1499, 0));
  EXPECT_TRUE(leases.take(0, b_sender, 1500, 0));
}

TEST(Lease, TwoProgramsOfOneNameAreTwoSenders) {
  LeaseTable leases{1, 500};
  leases.take(0, {.instance = 1, .name = "axes"}, 100, 3);

  EXPECT_FALSE(leases.take(0, {.instance = 2, .name = "axes"}, 101, 3));
  EXPECT_TRUE(leases.take(0, {.instance = 1, .name = "renamed"}, 101, 3));
}

TEST(Lease, OnlyItsHolderReleasesANode) {
  LeaseTable leases{1, 500};
  leases.take(0, a_sender, 100, 50);

  EXPECT_FALSE(leases.release(0, b_sender.instance, 101));
  EXPECT_TRUE(leases.release(0, a_sender.instance, 101));
  EXPECT_EQ(leases.holder(0, 101), "");
  EXPECT_EQ(leases.last_holder(0), "a");
  EXPECT_TRUE(leases.take(0, b_sender, 101, 50));
  EXPECT_FALSE(leases.release(0, a_sender.instance, 102)) << "it is another one's now";
}

TEST(Lease, NobodyHoldsANodeThatIsNotThere) {
  LeaseTable leases{1, 500};

  EXPECT_FALSE(leases.take(1, a_sender, 0, 1));
  EXPECT_EQ(leases.holder(1, 0), "");
}

}  // namespace
}  // namespace takt
