#include "master/rt/slack.hpp"

#include <gtest/gtest.h>

#include "master/core/machine.hpp"
#include "test/unit/master/rt/parts_rig.hpp"

namespace takt {
namespace {

const Frame request = make_frame(CobId::base(0x601), {0x40});

/// At 1 Mbit/s a dialogue takes up to 270 us, and the outputs are due 1600 us after SYNC. The nodes
/// exchange PDOs.
struct SlackTest : testing::Test {
  SlackTest() {
    parts.bus.takes_pdos = true;
    parts.await();
  }
  /// Runs a round that begins at this time after SYNC. Returns the number of frames sent.
  std::size_t round(Time after) {
    parts.port.sent.clear();
    parts.port.sleep_until(parts.beat.sync_at() + after);
    parts.slack.run_round();
    return parts.port.sent.size();
  }
  void next_cycle() {
    parts.beat.next();
    parts.await();
  }
  std::vector<Frame>& waiting() { return parts.bus.services.to_send; }

  Parts parts;
};

TEST_F(SlackTest, SendsWhatEndsBeforeTheOutputsWithItsAnswer) {
  waiting().assign(4, request);
  EXPECT_EQ(round(1000us), 2U);
  EXPECT_FALSE(parts.bus.service_frames.empty());
}

TEST_F(SlackTest, SendsNoMoreThanItsBudget) {
  parts.plan.cycle.service_frames = 3;
  waiting().assign(10, request);
  EXPECT_EQ(round(0us), 3U);
}

TEST_F(SlackTest, KeepsRoomForTheAnswersThatServersOwe) {
  parts.bus.services.awaited = 4;  // 540 us
  waiting().assign(4, request);
  EXPECT_EQ(round(900us), 0U);
}

TEST_F(SlackTest, ForcesOneFrameOutBehindSyncAfterTwoCyclesWithoutRoom) {
  waiting().assign(3, request);
  for (int i = 0; i < 2; ++i) {
    parts.slack.relieve_services();
    EXPECT_EQ(round(1500us), 0U);
    next_cycle();
  }
  parts.slack.relieve_services();
  EXPECT_EQ(parts.port.sent.size(), 1U);
  parts.slack.relieve_services();
  EXPECT_EQ(parts.port.sent.size(), 1U) << "and then waits again";
}

/// The device sends a sub-block for at most 40 ms.
TEST_F(SlackTest, SendsNothingBehindASubBlockUntilItsLatestEnd) {
  waiting().assign(1, request);
  parts.bus.services.answer = Answer::stream;
  EXPECT_EQ(round(0us), 1U);
  parts.bus.services.sub_blocks = 1;

  waiting().assign(1, request);
  parts.bus.services.answer = Answer::comes;
  for (next_cycle(); parts.beat.sync_at() < 10'042ms; next_cycle()) EXPECT_EQ(round(0us), 0U);
  EXPECT_EQ(parts.beat.sync_at(), 10'042ms);
  EXPECT_EQ(round(0us), 1U);
}

TEST_F(SlackTest, SendsBehindASubBlockThatHasEnded) {
  waiting().assign(1, request);
  parts.bus.services.answer = Answer::stream;
  EXPECT_EQ(round(0us), 1U);
  waiting().assign(1, request);
  next_cycle();
  EXPECT_EQ(round(0us), 1U);
}

TEST_F(SlackTest, DoesNothingAfterAStallUntilTheAbsenceIsExcused) {
  waiting().assign(1, request);
  EXPECT_EQ(round(5ms), 0U);
  EXPECT_EQ(waiting().size(), 1U) << "the state machines did not run";
}

TEST_F(SlackTest, ExcusesTheServicesForALongAbsence) {
  parts.slack.extend_deadlines();
  parts.beat.next();
  parts.port.stall = 400ms;
  parts.await();
  parts.slack.extend_deadlines();
  EXPECT_EQ(parts.bus.services.absences, std::vector<Time>{400ms});
}

TEST_F(SlackTest, SendsTimeOnlyIfItEndsBeforeTheOutputs) {
  BusPlan plan = test::axes();
  plan.time = {.period = 1s, .cob_id = CobId::base(0x100)};
  Parts own{plan};
  own.port.news_now.since_1970 = std::chrono::hours{500'000};
  own.await();
  own.port.sleep_until(10'003'590us);
  own.slack.run_round();
  EXPECT_TRUE(own.port.sent.empty());

  own.beat.next();
  own.await();
  own.slack.run_round();
  EXPECT_EQ(own.port.sent_with(0x100).size(), 1U);
}

TEST_F(SlackTest, ALongCycleHasManyRounds) {
  EXPECT_FALSE(parts.slack.has_many_rounds());
  parts.plan.cycle.period = 100ms;
  parts.plan.cycle.output_deadline = 90ms;
  EXPECT_TRUE(parts.slack.has_many_rounds());
  EXPECT_TRUE(parts.slack.rest_until_next_round());
  EXPECT_EQ(parts.port.now(), 10'012ms);
  parts.port.sleep_until(10'082ms);
  EXPECT_FALSE(parts.slack.rest_until_next_round()) << "the outputs come next";
}

}  // namespace
}  // namespace takt
