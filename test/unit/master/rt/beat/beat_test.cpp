#include "master/rt/beat/beat.hpp"

#include <gtest/gtest.h>

#include "test/unit/master/rt/parts_rig.hpp"

namespace takt {
namespace {

TEST(Beat, HasTheTimesOfTheCycle) {
  Parts parts;
  parts.await();
  const Beat& beat = parts.beat;
  EXPECT_EQ(beat.cycle(), 1U);
  EXPECT_EQ(beat.sync_at(), 10'002ms);
  EXPECT_EQ(beat.window_end(), 10'003'200us);
  EXPECT_EQ(beat.outputs_due(), 10'003'600us);
  EXPECT_EQ(beat.next_deadline(), 10'004ms);
  EXPECT_TRUE(beat.wire_open());

  parts.beat.next();
  EXPECT_EQ(beat.cycle(), 2U);
  EXPECT_EQ(beat.deadline(), 10'004ms);
}

TEST(Beat, SkipsThePeriodsThatHavePassed) {
  Parts parts;
  parts.port.stall = 5ms;
  parts.await();
  EXPECT_EQ(parts.beat.sync_at(), 10'008ms);
  EXPECT_EQ(parts.beat.cycle(), 4U);
  EXPECT_EQ(parts.bus.status.cycles_missed, 3U);
  EXPECT_EQ(parts.reported(), std::vector{EventKind::cycles_missed});
}

TEST(Beat, ALateSyncEndsTheWindowAtTheOutputs) {
  Parts parts;
  parts.port.stall = 900us;
  parts.await();
  EXPECT_EQ(parts.beat.sync_at(), 10'002'900us);
  EXPECT_EQ(parts.beat.window_end(), 10'003'600us);
  EXPECT_EQ(parts.bus.status.cycles_late, 1U);
}

TEST(Beat, CountsAnAbsenceOnceAndOnlyIfItIsLong) {
  Parts parts;
  parts.await();
  EXPECT_EQ(parts.beat.take_absence(), 0s);
  parts.beat.next();
  parts.port.stall = 50ms;
  parts.await();
  EXPECT_EQ(parts.beat.take_absence(), 50ms);
  EXPECT_EQ(parts.beat.take_absence(), 0s);
}

TEST(Beat, HoldsTheFramesOfACycleWhileItsSyncWasNotSeen) {
  Parts parts;
  parts.port.news_now.last_sync_echo = 10'001ms;
  parts.await();
  EXPECT_TRUE(parts.beat.wire_open());
  parts.beat.on_sync_sent();
  parts.beat.next();

  parts.await();
  EXPECT_FALSE(parts.beat.wire_open());
  const Frame frame{.id = CobId::base(0x201)};
  EXPECT_EQ(parts.sender.send({&frame, 1}), 0U);
  EXPECT_TRUE(parts.port.sent.empty());
  EXPECT_TRUE(parts.reported().empty());

  parts.beat.next();
  parts.port.news_now.last_sync_echo = 10'005ms;
  parts.await();
  EXPECT_TRUE(parts.beat.wire_open());
  EXPECT_EQ(parts.sender.send({&frame, 1}), 1U);
  EXPECT_EQ(parts.reported(), std::vector{EventKind::cycles_missed});
}

TEST(Beat, CountsItsSyncOnlyWhenItWasSent) {
  BusPlan plan = test::axes();
  plan.cycle.sync_overflow = 3;
  Parts parts{plan};
  EXPECT_EQ(parts.beat.sync().data[0], 1);
  EXPECT_EQ(parts.beat.sync().data[0], 1);
  parts.beat.on_sync_sent();
  EXPECT_EQ(parts.beat.sync().data[0], 2);
  parts.beat.restart_counter();
  EXPECT_EQ(parts.beat.sync().data[0], 1);
}

struct FollowedBeat : testing::Test {
  static BusPlan followed() {
    BusPlan plan = test::axes();
    plan.cycle.sync_followed = true;
    plan.cycle.sync_timeout = 5ms;
    return plan;
  }
  const Frame sync{.id = CobId::base(0x080)};
  Parts parts{followed()};
};

TEST_F(FollowedBeat, BeginsWithTheArrivalOfSync) {
  parts.arrive(10'002'300us, sync);
  parts.await();
  EXPECT_TRUE(parts.beat.began_by_sync());
  EXPECT_EQ(parts.beat.sync_at(), 10'002'300us);
  EXPECT_EQ(parts.beat.sync_state(), SyncState::locked);
}

TEST_F(FollowedBeat, BeginsByItsOwnClockWithoutSyncAndNoticesTheLoss) {
  parts.arrive(10'002ms, sync);
  parts.await();
  parts.beat.next();
  parts.await();
  EXPECT_FALSE(parts.beat.began_by_sync());
  EXPECT_FALSE(parts.beat.sync_lost());
  EXPECT_EQ(parts.bus.status.cycles_missed, 1U);
  parts.beat.next();
  parts.await();
  EXPECT_TRUE(parts.beat.sync_lost());
  EXPECT_EQ(parts.reported(), (std::vector{EventKind::sync_back, EventKind::sync_lost}));
}

TEST_F(FollowedBeat, PassesOverASyncThatIsTooOldToBeginACycle) {
  parts.arrive(10'002ms, sync);
  parts.arrive(10'004ms, sync);
  parts.port.sleep_until(10'004'100us);
  parts.await();
  EXPECT_EQ(parts.beat.sync_at(), 10'004ms);
}

/// The drives have acted on this SYNC, so the motions must go on.
TEST_F(FollowedBeat, ACycleWhoseSyncIsTooOldWhenItIsFoundHasASync) {
  parts.arrive(10'002ms, sync);
  parts.await();
  parts.beat.next();
  parts.arrive(10'004ms, sync);
  parts.port.sleep_until(10'005'500us);
  parts.await();
  EXPECT_FALSE(parts.beat.began_by_sync());
  EXPECT_TRUE(parts.beat.has_sync());
  parts.beat.next();
  parts.await();
  EXPECT_FALSE(parts.beat.has_sync());
}

}  // namespace
}  // namespace takt
