#include "master/core/node/node_guard.hpp"

#include <gtest/gtest.h>

#include "test/unit/master/core/network/network_rig.hpp"

namespace takt {
namespace {

constexpr GuardPlan guard_plan{.period = 100ms, .retries = 3};

TEST(NodeGuard, AsksAtOnceAndThenEachPeriod) {
  NodeGuard guard{guard_plan};
  guard.start(10s);
  EXPECT_TRUE(guard.wants_request(10s));
  guard.request_sent(10s);
  EXPECT_FALSE(guard.wants_request(10s + 99ms));
  EXPECT_TRUE(guard.wants_request(10s + 100ms));
}

TEST(NodeGuard, DoesNothingWithoutAGuardTime) {
  NodeGuard guard{GuardPlan{}};
  guard.start(10s);
  EXPECT_FALSE(guard.running());
  EXPECT_EQ(guard.deadline(), never);
}

TEST(NodeGuard, FirstAnswerAfterABootUpHasToggleBitZero) {
  NodeGuard guard{guard_plan};
  guard.node_was_reset();
  guard.start(10s);
  EXPECT_FALSE(guard.on_answer(true, 10s));
  EXPECT_TRUE(guard.on_answer(false, 10s));
  EXPECT_TRUE(guard.on_answer(true, 10s));
  EXPECT_FALSE(guard.on_answer(true, 10s));
  EXPECT_EQ(guard.repeated(), 1u);
}

TEST(NodeGuard, CountsNoSilenceWhileTheMasterWasAway) {
  NodeGuard guard{guard_plan};
  guard.start(10s);
  guard.extend_deadlines(500ms);
  EXPECT_FALSE(guard.on_time(10s + 800ms - 1ns));
  EXPECT_EQ(guard.on_time(10s + 800ms), Time{300ms});
}

TEST(NodeGuard, TakesEitherToggleBitFromANodeThatWasNotReset) {
  NodeGuard guard{guard_plan};
  guard.start(10s);
  EXPECT_TRUE(guard.on_answer(true, 10s));
}

TEST(NodeGuard, IsLostOnceAfterTheLifeTimeAndArmedAgainByAnAnswer) {
  NodeGuard guard{guard_plan};
  guard.start(10s);
  EXPECT_TRUE(guard.on_answer(false, 10s + 50ms));
  EXPECT_FALSE(guard.on_time(10s + 349ms));
  EXPECT_EQ(guard.on_time(10s + 350ms), Time{300ms});
  EXPECT_FALSE(guard.on_time(11s));
  EXPECT_TRUE(guard.on_answer(false, 11s));
  EXPECT_FALSE(guard.on_time(11s + 299ms));
  EXPECT_TRUE(guard.on_time(11s + 300ms));
}

TEST(NodeGuard, AfterLostRequestsThereIsNoBurst) {
  NodeGuard guard{guard_plan};
  guard.start(10s);
  guard.request_sent(10s + 950ms);
  EXPECT_FALSE(guard.wants_request(10s + 1049ms));
}

class GuardedNode : public testing::Test, public NetworkRig {};

TEST_F(GuardedNode, IsAskedByRemoteFramesOfOneByte) {
  Steps steps;
  steps.wait(BootAction::await_guarding, 'K', 300ms).nmt(NmtCommand::start);
  add(5, std::move(steps.plan)).guard = guard_plan;
  start();
  run(1ms);
  ASSERT_FALSE(sent.empty());
  EXPECT_EQ(sent.front().id, CobId::base(0x705));
  EXPECT_TRUE(sent.front().rtr);
  EXPECT_EQ(sent.front().length, 1);

  hear(heartbeat(0x7F));
  run(1ms);
  EXPECT_EQ(status().boot, BootState::ready);
  hear(heartbeat(0x85));
  EXPECT_EQ(status().nmt, NmtState::operational);
  run(299ms);
  EXPECT_EQ(count(EventKind::guarding_lost), 0);
  run(2ms);
  EXPECT_EQ(count(EventKind::guarding_lost), 1);
  EXPECT_EQ(status().boot, BootState::lost);
}

}  // namespace
}  // namespace takt
