#include "master/gateway/front_gap.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

using namespace std::chrono_literals;

TEST(FrontGap, AThreadThatKeepsItsTimetableHasNone) {
  FrontGap gap{2ms};
  EXPECT_FALSE(gap.ran(1s)) << "the first time";
  gap.sleeps_until(1100ms);
  EXPECT_FALSE(gap.ran(1150ms));
  EXPECT_FALSE(gap.discards_commands(1150ms));
}

TEST(FrontGap, CommandsAreDiscardedAfterAShortOneAndRequestsAfterASecond) {
  FrontGap gap{2ms};
  gap.ran(1s);
  EXPECT_TRUE(gap.ran(1200ms));
  EXPECT_EQ(gap.length(), 200ms);
  gap.found_empty();
  EXPECT_TRUE(gap.discards_commands(1219ms));
  EXPECT_FALSE(gap.discards_requests(1219ms));
  EXPECT_FALSE(gap.discards_commands(1220ms));
  EXPECT_TRUE(gap.ran(3s));
  EXPECT_TRUE(gap.discards_requests(3s));
}

TEST(FrontGap, WhatWaitedIsDiscardedUntilTheTransportsAreEmptyButAtMostForASecond) {
  FrontGap gap{2ms};
  gap.ran(1s);
  EXPECT_TRUE(gap.ran(9s));

  EXPECT_TRUE(gap.discards_commands(9900ms));
  EXPECT_TRUE(gap.discards_requests(9999ms));
  EXPECT_FALSE(gap.discards_requests(10s));
  gap.found_empty();
  EXPECT_FALSE(gap.discards_requests(9900ms));
}

TEST(FrontGap, AShortGapDoesNotHideALongOne) {
  FrontGap gap{2ms};
  gap.ran(1s);
  gap.ran(9s);
  gap.ran(9500ms);

  EXPECT_EQ(gap.length(), 500ms);
  EXPECT_EQ(gap.newest_long().length, 8s);
  EXPECT_EQ(gap.newest_long().end, 9s);
}

}  // namespace
}  // namespace takt
