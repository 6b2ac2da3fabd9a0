#include <array>
#include <gtest/gtest.h>
#include <memory>

#include "apps/takt/soak/evidence/image_judge.hpp"
#include "apps/takt/soak/judge/node_judge.hpp"
#include "apps/takt/soak/judge/output_judge.hpp"
#include "apps/takt/soak/random_user.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

/// Two axes with a cycle of 2 ms. Signals 0 to 3 are 6041 and 6064 of both axes, signals 4 to 7 are
/// 6040 and 607A.
class Judges : public testing::Test {
 protected:
  void hear(std::initializer_list<std::uint8_t> bytes) {
    images.on_wire({.frame = make_frame(CobId::base(0x181), bytes)});
  }
  void show(std::uint64_t cycle, std::int64_t word, std::int64_t position) {
    values[0] = word;
    values[2] = position;
    images.judge({{.cycle = cycle, .publish_time = Time{1ms} * cycle}, values, {}});
  }

  BusPlan plan = test::axes({.fallback_cycles = 5});
  Verdict verdict;
  ImageJudge images{plan, verdict};
  OutputJudge outputs{plan, verdict};
  std::vector<std::int64_t> values = std::vector<std::int64_t>(8);
};

TEST_F(Judges, TakeAnImageWhoseValuesCameInOneFrame) {
  hear({0x37, 0x02, 0xFF, 0xFF, 0xFF, 0xFF});
  hear({0x27, 0x02, 0x05, 0x00, 0x00, 0x00});

  show(1, 0x0237, -1);
  show(2, 0x0227, 5);
  show(4, 0x0227, 5);

  EXPECT_TRUE(verdict.good());
}

TEST_F(Judges, BlameAnImageOfTwoFrames) {
  hear({0x37, 0x02, 0xFF, 0xFF, 0xFF, 0xFF});
  hear({0x27, 0x02, 0x05, 0x00, 0x00, 0x00});

  show(1, 0x0237, 5);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "no torn image");
}

TEST_F(Judges, BlameAnImageThatGoesBackToAnOlderFrame) {
  hear({0x37, 0x02, 0xFF, 0xFF, 0xFF, 0xFF});
  hear({0x27, 0x02, 0x05, 0x00, 0x00, 0x00});
  show(1, 0x0227, 5);

  show(2, 0x0237, -1);

  EXPECT_FALSE(verdict.good());
}

class SyncJudge : public Judges {
 protected:
  SyncJudge() { plan.cycle.sync_overflow = 10; }
  void syncs(std::initializer_list<std::uint8_t> counters) {
    for (const std::uint8_t counter : counters) {
      outputs.sent({{make_frame(CobId::base(0x080), {counter})}}, now += 2ms);
    }
  }
  void nmt(NmtCommand command) { outputs.sent({{encode(NmtMessage{command, 0})}}, now); }

  Time now = 1s;
};

TEST_F(SyncJudge, BlamesACounterThatLeavesOneOut) {
  syncs({1, 2, 4});
  EXPECT_FALSE(verdict.good());
}

TEST_F(SyncJudge, BlamesACounterThatStartsAnewForNoReason) {
  syncs({1, 2, 3, 1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_TRUE(verdict.good()) << "its reason may still wait to be sent";
  syncs({9, 10, 1, 2, 3, 4});
  EXPECT_FALSE(verdict.good());
}

TEST_F(SyncJudge, TakesACounterThatStartsAnewWithTheNetwork) {
  syncs({1, 2, 3});
  nmt(NmtCommand::reset_node);
  syncs({1, 2});
  nmt(NmtCommand::stop);
  syncs({3, 4});
  nmt(NmtCommand::start);
  syncs({1, 2, 1, 2});  // before there is room for the command
  nmt(NmtCommand::reset_communication);
  syncs({3, 4, 5, 6, 7, 8, 9, 10, 1, 2, 3, 4});
  EXPECT_TRUE(verdict.good());
}

TEST_F(SyncJudge, TakesOneRestartForEachCommandToTheMasterItself) {
  syncs({1, 2, 3});
  outputs.ordered();
  syncs({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 1, 2, 3});
  EXPECT_TRUE(verdict.good());
  syncs({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 1, 2, 3});
  EXPECT_FALSE(verdict.good());
}

TEST_F(SyncJudge, BlamesARestartByCommandsThatStartNothingAnew) {
  syncs({1, 2, 3});
  nmt(NmtCommand::start);
  syncs({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 1, 2, 3});
  EXPECT_FALSE(verdict.good());
}

TEST_F(Judges, BlameACycleNumberThatStays) {
  show(7, 0, 0);
  show(7, 0, 0);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "cycle numbers rise");
}

TEST_F(Judges, BlameAControlwordBeyondItsTimeToLive) {
  const Frame enable = make_frame(CobId::base(0x201), {0x0F, 0x00, 0x00, 0x00, 0x00, 0x00});
  outputs.commanded(4, 0x000F, 3, 100ms);

  outputs.sent({&enable, 1}, 110ms);  // 5 periods
  EXPECT_TRUE(verdict.good());
  outputs.sent({&enable, 1}, 112ms);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "no stale output");
}

TEST_F(Judges, TakeAQuickStopWithoutACommand) {
  const Frame stop = make_frame(CobId::base(0x201), {0x02, 0x00, 0x00, 0x00, 0x00, 0x00});

  outputs.sent({&stop, 1}, 100ms);

  EXPECT_TRUE(verdict.good());
}

TEST_F(Judges, BlameTwoSyncsAtOnce) {
  const Frame sync = make_frame(CobId::base(0x080), {});

  outputs.sent({&sync, 1}, 100ms);
  outputs.sent({&sync, 1}, 100ms + 200us);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "no burst of SYNCs");
}

TEST_F(Judges, BlameAnImageThatWasPublishedBeforeTheOneBefore) {
  images.judge({{.cycle = 1, .publish_time = 9ms}, values, {}});
  images.judge({{.cycle = 2, .publish_time = 8ms}, values, {}});

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "cycle numbers rise");
}

TEST_F(Judges, BlameAnImageThatWasPublishedBeforeItsSync) {
  images.judge({{.cycle = 1, .sync_time = 9ms, .publish_time = 8ms}, values, {}});

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "an image is published after its SYNC");
}

TEST_F(Judges, BlameAValueWithoutItsSign) {
  hear({0x37, 0x02, 0xFF, 0xFF, 0xFF, 0xFF});

  show(1, 0x0237, 0xFFFF'FFFF);

  EXPECT_FALSE(verdict.good());
}

TEST_F(Judges, BlameASyncCounterWithAGap) {
  plan.cycle.sync_overflow = 3;
  Time now = 100ms;
  for (const std::uint8_t counter : std::array<std::uint8_t, 4>{1, 2, 3, 1}) {
    const Frame sync = make_frame(CobId::base(0x080), {counter});
    outputs.sent({&sync, 1}, now += 2ms);
  }
  EXPECT_TRUE(verdict.good());
  const Frame third = make_frame(CobId::base(0x080), {3});
  outputs.sent({&third, 1}, now + 2ms);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "the SYNC counter has no gap");
}

TEST_F(Judges, KeepTheFirstViolationAndItsCycle) {
  verdict.at(7, 14ms);
  show(7, 0, 0);
  show(7, 0, 0);
  verdict.at(8, 16ms);
  show(9, 0x0237, 5);

  EXPECT_EQ(verdict.violation()->cycle, 7U);
  EXPECT_EQ(verdict.violation()->when, 14ms);
  EXPECT_EQ(verdict.violation()->invariant, "cycle numbers rise");
}

/// Two nodes that are ready.
class NodeJudges : public testing::Test {
 protected:
  NodeJudges() {
    status.nodes.assign(2, {});
    for (NodeStatus& node : status.nodes) {
      node.boot = BootState::ready;
      node.nmt = NmtState::operational;
    }
  }

  BusPlan plan = test::axes({});
  Verdict verdict;
  NodeJudge nodes{plan, verdict};
  StatusSnapshot status;
};

TEST_F(NodeJudges, BlameAnNmtStateThatNobodyKnows) {
  nodes.judge(status, 1s);
  EXPECT_TRUE(verdict.good());
  status.nodes[1].nmt = static_cast<NmtState>(0x42);
  nodes.judge(status, 1s);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "every node is in a named state");
  EXPECT_EQ(verdict.violation()->what, "node 2 is ready, NMT state 66, boot step 1");
}

TEST_F(NodeJudges, BlameABootStateThatNobodyKnows) {
  status.nodes[0].boot = static_cast<BootState>(5);
  nodes.judge(status, 1s);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "every node is in a named state");
}

TEST_F(NodeJudges, BlameABootThatStaysAtOneStep) {
  status.nodes[0].boot = BootState::booting;
  nodes.judge(status, 1s);
  status.nodes[0].boot_step = 4;
  nodes.judge(status, 60s);
  nodes.judge(status, 120s);
  EXPECT_TRUE(verdict.good()) << "it went on at 60 s";
  nodes.judge(status, 121s);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "every wait ends");
}

TEST_F(NodeJudges, BlameANodeThatIsNotReadyInTheEnd) {
  EXPECT_TRUE(nodes.all_ready(status));
  nodes.judge_end(status);
  EXPECT_TRUE(verdict.good());
  status.nodes[1].nmt = NmtState::preoperational;
  EXPECT_FALSE(nodes.all_ready(status));
  nodes.judge_end(status);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "every node comes back");
}

/// A user whose only request was sent at 1 s.
class Asked : public testing::Test {
 protected:
  Asked() {
    while (user.asked() == 0) user.ask(1s);
  }
  void answer(std::uint64_t id) { exchange->replies.push({.id = id}); }

  BusPlan plan = test::axes({});
  Verdict verdict;
  OutputJudge outputs{plan, verdict};
  std::unique_ptr<Exchange> exchange = std::make_unique<Exchange>(plan);
  RandomUser user{plan, *exchange, outputs, verdict, sim::Random{1}};
};

TEST_F(Asked, IsContentWithOneAnswer) {
  EXPECT_EQ(user.unanswered(), 1U);
  answer(1);
  user.take_replies(2s);
  user.take_replies(1h);

  EXPECT_EQ(user.unanswered(), 0U);
  EXPECT_TRUE(verdict.good());
}

TEST_F(Asked, BlamesASecondAnswer) {
  answer(1);
  answer(1);
  user.take_replies(2s);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "every request is answered once");
}

TEST_F(Asked, BlamesAnAnswerThatNobodyAskedFor) {
  answer(9);
  user.take_replies(2s);

  EXPECT_FALSE(verdict.good());
}

TEST_F(Asked, BlamesAnAnswerThatStaysAway) {
  user.take_replies(121s);
  EXPECT_TRUE(verdict.good());
  user.take_replies(122s);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->what, "request 1 has no answer after 120 s");
}

}  // namespace
}  // namespace takt::soak
