#include "master/gateway/command/lease.hpp"

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

TEST(Freshness, KnowsWhichLimitAppliesAndWhereItComesFrom) {
  const auto limit = [](std::uint32_t time_to_live, std::uint32_t configured) {
    return freshness({.computed_from = 98,
                      .now = 100,
                      .time_to_live = time_to_live,
                      .configured = configured,
                      .most = 500})
        .limit;
  };

  EXPECT_EQ(limit(20, 1000).cycles, 20U);
  EXPECT_EQ(limit(20, 1000).origin, LimitOrigin::command);
  EXPECT_EQ(limit(2000, 1000).cycles, 1000U);
  EXPECT_EQ(limit(2000, 1000).origin, LimitOrigin::configured);
  EXPECT_EQ(limit(0, 1000).origin, LimitOrigin::configured);
  EXPECT_EQ(limit(20, 0).cycles, 20U);
  EXPECT_EQ(limit(20, 0).origin, LimitOrigin::command);
  EXPECT_EQ(limit(0, 0).cycles, 0U) << "no limit";
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

/// Takes the node by a command computed from the present cycle. Returns true if the sender then
/// holds the node.
bool take(LeaseTable& leases, std::size_t node, const Sender& sender, std::uint64_t now,
          std::uint32_t cycles) {
  return leases.take(node, sender, {.now = now, .cycles = cycles, .computed_from = now}) ==
         LeaseVerdict::taken;
}

/// Takes node 0 by a command of `a_sender` in cycle 110, with a time to live of 50 cycles.
LeaseVerdict take_from(LeaseTable& leases, std::uint64_t computed_from) {
  return leases.take(0, a_sender, {.now = 110, .cycles = 50, .computed_from = computed_from});
}

TEST(Lease, FirstSenderHoldsTheNodeUntilItsTimeToLiveHasRunOut) {
  LeaseTable leases{2, 500};

  EXPECT_TRUE(take(leases, 0, a_sender, 100, 3));
  EXPECT_FALSE(take(leases, 0, b_sender, 102, 3));
  EXPECT_EQ(leases.holder(0, 102), "a");
  EXPECT_TRUE(take(leases, 0, b_sender, 103, 3));
  EXPECT_FALSE(take(leases, 0, a_sender, 104, 3));
}

TEST(Lease, EachCommandProlongsIt) {
  LeaseTable leases{1, 500};
  take(leases, 0, a_sender, 100, 3);

  EXPECT_TRUE(take(leases, 0, a_sender, 102, 3));

  EXPECT_FALSE(take(leases, 0, b_sender, 104, 3));
  EXPECT_TRUE(take(leases, 0, b_sender, 105, 3));
}

/// A motion may have a longer time-out than the command that enables its drive.
TEST(Lease, AShorterCommandOfTheHolderDoesNotShortenIt) {
  LeaseTable leases{1, 500};
  take(leases, 0, a_sender, 100, 50);

  EXPECT_TRUE(take(leases, 0, a_sender, 101, 3));

  EXPECT_TRUE(leases.holds(0, a_sender.instance, 149));
  EXPECT_FALSE(leases.holds(0, a_sender.instance, 150));
  EXPECT_TRUE(take(leases, 0, a_sender, 149, 50));
  EXPECT_TRUE(leases.release(0, 151, 151));
  EXPECT_TRUE(take(leases, 0, a_sender, 152, 3));
  EXPECT_FALSE(leases.holds(0, a_sender.instance, 155)) << "the release has ended the longer one";
}

TEST(Lease, NodesAreHeldSeparately) {
  LeaseTable leases{2, 500};
  take(leases, 0, a_sender, 1, 10);

  EXPECT_TRUE(take(leases, 1, b_sender, 1, 10));
  EXPECT_EQ(leases.holder(0, 2), "a");
  EXPECT_EQ(leases.holder(1, 2), "b");
}

TEST(Lease, WithoutTimeToLiveItEndsAfterTheUnlimitedTime) {
  LeaseTable leases{1, 500};
  take(leases, 0, a_sender, 1000, 0);

  EXPECT_FALSE(take(leases, 0, b_sender, 1499, 0));
  EXPECT_TRUE(take(leases, 0, b_sender, 1500, 0));
}

TEST(Lease, TwoProgramsOfOneNameAreTwoSenders) {
  LeaseTable leases{1, 500};
  take(leases, 0, {.instance = 1, .name = "axes"}, 100, 3);

  EXPECT_FALSE(take(leases, 0, {.instance = 2, .name = "axes"}, 101, 3));
  EXPECT_TRUE(take(leases, 0, {.instance = 1, .name = "renamed"}, 101, 3));
}

TEST(Lease, OnlyItsHolderReleasesANode) {
  LeaseTable leases{1, 500};
  take(leases, 0, a_sender, 100, 50);

  EXPECT_FALSE(leases.holds(0, b_sender.instance, 101));
  EXPECT_TRUE(leases.holds(0, a_sender.instance, 101));
  EXPECT_TRUE(leases.release(0, 101, 101));
  EXPECT_EQ(leases.holder(0, 101), "");
  EXPECT_EQ(leases.last_holder(0), "a");
  EXPECT_TRUE(take(leases, 0, b_sender, 101, 50));
  EXPECT_FALSE(leases.holds(0, a_sender.instance, 102)) << "it is another one's now";
}

TEST(Lease, AnEarlierCommandDoesNotOvertakeALaterOne) {
  LeaseTable leases{1, 500};

  EXPECT_EQ(take_from(leases, 105), LeaseVerdict::taken);
  EXPECT_EQ(take_from(leases, 104), LeaseVerdict::overtaken);
  EXPECT_EQ(take_from(leases, 105), LeaseVerdict::taken) << "a program may send twice in a cycle";
  EXPECT_EQ(take_from(leases, 106), LeaseVerdict::taken);
  EXPECT_EQ(take_from(leases, 105), LeaseVerdict::overtaken);
}

TEST(Lease, AnEarlierCommandDoesNotTakeANodeThatWasReleased) {
  LeaseTable leases{1, 500};
  EXPECT_EQ(take_from(leases, 105), LeaseVerdict::taken);

  EXPECT_FALSE(leases.release(0, 110, 104)) << "an earlier release";
  EXPECT_TRUE(leases.release(0, 110, 105));

  EXPECT_EQ(take_from(leases, 104), LeaseVerdict::overtaken);
  EXPECT_EQ(take_from(leases, 105), LeaseVerdict::released) << "it was sent before the release";
  EXPECT_EQ(take_from(leases, 106), LeaseVerdict::taken);
}

/// A sign of life is no order. A release from an earlier cycle takes effect although a later sign
/// of life was read first.
TEST(Lease, ASignOfLifeThatHasOvertakenAReleaseChangesNothing) {
  LeaseTable leases{1, 500};
  const auto sign_from = [&](std::uint64_t cycle) {
    const LeaseTerm term{.now = 110, .cycles = 50, .computed_from = cycle, .is_sign_of_life = true};
    return leases.take(0, a_sender, term);
  };
  EXPECT_EQ(take_from(leases, 105), LeaseVerdict::taken);
  EXPECT_EQ(sign_from(107), LeaseVerdict::taken);
  EXPECT_TRUE(leases.release(0, 110, 106));
  EXPECT_FALSE(leases.holds(0, a_sender.instance, 110));

  EXPECT_EQ(sign_from(106), LeaseVerdict::overtaken);
  EXPECT_EQ(sign_from(108), LeaseVerdict::taken);
  EXPECT_FALSE(leases.release(0, 110, 106)) << "a copy";
  EXPECT_EQ(take_from(leases, 109), LeaseVerdict::taken);
  EXPECT_FALSE(leases.release(0, 110, 108)) << "a later command has overtaken it";
}

TEST(Lease, ACycleThatHasNotComeYetKeepsNobodyOut) {
  LeaseTable leases{1, 500};
  EXPECT_TRUE(take(leases, 0, a_sender, 900, 50)) << "the clock ran on while SYNC stood still";

  EXPECT_EQ(take_from(leases, 109), LeaseVerdict::taken);
  EXPECT_FALSE(leases.holds(0, a_sender.instance, 160)) << "nor does it hold the node";
}

TEST(Lease, NobodyHoldsANodeThatIsNotThere) {
  LeaseTable leases{1, 500};

  EXPECT_FALSE(take(leases, 1, a_sender, 0, 1));
  EXPECT_EQ(leases.holder(1, 0), "");
}

}  // namespace
}  // namespace takt
