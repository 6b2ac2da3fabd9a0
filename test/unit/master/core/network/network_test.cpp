#include "master/core/network/network.hpp"

#include <gtest/gtest.h>
#include <set>

#include "test/unit/master/core/network/network_fixture.hpp"

namespace takt {
namespace {

TEST_F(NetworkTest, BootsEightNodesInParallelWithinTheFrameBudget) {
  plan.cycle.service_frames = 3;
  for (std::uint8_t id = 1; id <= 8; ++id) add_drive(id);
  start();
  run(60ms);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(status(i).boot, BootState::ready) << i;
  EXPECT_EQ(most_frames, 3U);
}

TEST_F(NetworkTest, GivesEveryNodeItsTurn) {
  plan.cycle.service_frames = 1;
  for (std::uint8_t id = 1; id <= 4; ++id) add_drive(id);
  start();
  run(4ms);
  EXPECT_EQ(sent.size(), 4U);
  EXPECT_EQ(
      (std::set<std::uint8_t>{sent[0].data[1], sent[1].data[1], sent[2].data[1], sent[3].data[1]}),
      (std::set<std::uint8_t>{1, 2, 3, 4}));
}

TEST_F(NetworkTest, BootsOneNodeWhileAnotherIsMute) {
  add_drive(5);
  add_drive(6);
  device(0).on = false;
  start();
  run(100ms);
  EXPECT_EQ(status(0).boot, BootState::booting);
  EXPECT_EQ(status(1).boot, BootState::ready);
  EXPECT_TRUE(network->exchanges_pdos(1));
}

TEST_F(NetworkTest, ReportsALostHeartbeatAtItsDeadlineAndBootsTheNodeAgain) {
  add_drive();
  start();
  run(200ms);
  ASSERT_TRUE(network->exchanges_pdos(0));
  const Time last = status().last_heartbeat;
  device().on = false;
  run(last + 150ms - 1ns - now);
  EXPECT_EQ(count(EventKind::heartbeat_lost), 0);
  run(1ns);
  ASSERT_EQ(count(EventKind::heartbeat_lost), 1);
  EXPECT_EQ(find(EventKind::heartbeat_lost)->value, 150'000'000);
  EXPECT_EQ(status().boot, BootState::lost);
  EXPECT_EQ(status().nmt, NmtState::unknown);
  EXPECT_FALSE(network->exchanges_pdos(0));

  sent.clear();
  device().on = true;
  device().next_heartbeat = never;
  run(999ms);
  EXPECT_TRUE(sent.empty());
  run(100ms);
  EXPECT_EQ(sent_count(nmt({0x82, 0x05})), 1);
  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_EQ(status().boot_count, 2U);
}

TEST_F(NetworkTest, BootsANodeAtOnceWhenItsHeartbeatComesBack) {
  add_drive();
  start();
  run(200ms);
  device().on = false;
  run(200ms);
  ASSERT_EQ(status().boot, BootState::lost);
  device().on = true;
  device().heartbeats(now, 50ms);
  run(150ms);
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(NetworkTest, BootsANodeThatRestartedWithoutResettingItAgain) {
  add_drive();
  start();
  run(200ms);
  sent.clear();
  hear(heartbeat(0x00));
  EXPECT_FALSE(network->exchanges_pdos(0));
  EXPECT_EQ(count(EventKind::bootup_again), 1);
  run(40ms);
  EXPECT_EQ(sent_count(nmt({0x82, 0x05})), 0);
  EXPECT_EQ(sent_count(nmt({0x01, 0x05})), 1);
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(NetworkTest, ReportsEachBootUpMessage) {
  add_drive();
  start();
  const auto bootups = [&] {
    return std::ranges::count_if(events, [](const Event& event) {
      return event.kind == EventKind::bootup_again ||
             (event.kind == EventKind::node_state && event.value == 0);
    });
  };
  run(200ms);
  EXPECT_EQ(bootups(), 1) << "after the reset of its boot";
  hear(heartbeat(0x00));
  EXPECT_EQ(bootups(), 2) << "it was ready";
  hear(heartbeat(0x00));
  EXPECT_EQ(bootups(), 3) << "it was booting";
}

TEST_F(NetworkTest, BootsAFailedNodeAtOnceWithItsNextBootUpMessage) {
  add_drive();
  device().on = false;
  start();
  run(1800ms);
  ASSERT_EQ(status().boot, BootState::failed);
  device().on = true;
  hear(heartbeat(0x00));
  run(20ms);
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(NetworkTest, ReportsOfANodeThatStaysAwayMoreAndMoreRarely) {
  add_drive();
  device().on = false;
  start();
  run(60s);
  EXPECT_GT(sent_count(nmt({0x82, 0x05})), 16);
  EXPECT_LE(count(EventKind::boot_failed), 6);
  EXPECT_GE(count(EventKind::boot_failed), 4);
  EXPECT_LE(count(EventKind::boot_started), 6);
}

TEST_F(NetworkTest, CountsNoTimeOfItsOwnAbsenceWhileItBoots) {
  NodePlan& drive = add_drive();
  drive.boot_plan.steps.insert(drive.boot_plan.steps.end() - 1,
                               {.action = BootAction::await_heartbeat, .timeout = 100ms});
  start();
  run(30ms);
  ASSERT_EQ(status().boot, BootState::booting);
  ASSERT_EQ(status().boot_step, 3);

  now += 2s;
  network->on_absence(2s);
  step();
  run(100ms);

  EXPECT_EQ(count(EventKind::boot_failed), 0);
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(NetworkTest, FollowsTheStateInTheHeartbeat) {
  add_drive();
  start();
  run(200ms);
  events.clear();
  device().state = 0x7F;  // the drive leaves OPERATIONAL by itself
  run(60ms);
  EXPECT_FALSE(network->exchanges_pdos(0));
  ASSERT_EQ(count(EventKind::node_state), 1);
  EXPECT_EQ(find(EventKind::node_state)->value, 0x7F);
}

TEST_F(NetworkTest, BringsBackANodeThatLeftOperationalByItself) {
  add_drive();
  start();
  run(200ms);
  sent.clear();
  device().state = 0x7F;
  run(1s);
  EXPECT_EQ(status().boot, BootState::lost);
  run(200ms);
  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_EQ(sent_count(nmt({0x82, 0x05})), 0);  // the configuration is read back, not reset
  EXPECT_EQ(sent_count(nmt({0x01, 0x05})), 1);
  EXPECT_TRUE(network->exchanges_pdos(0));
}

/// Status L of CiA 302-2: the boot sends no NMT command.
TEST_F(NetworkTest, BringsBackANodeThatWasFoundOperational) {
  std::vector<BootStep>& steps = add_drive().boot_plan.steps;
  steps.insert(steps.begin(),
               {.action = BootAction::await_alive, .letter = 'E', .target = 3, .timeout = 200ms});
  device().state = 5;
  start();
  run(300ms);
  ASSERT_EQ(status().boot_letter, 'L');
  ASSERT_EQ(sent_count(nmt({0x01, 0x05})), 0);
  device().state = 0x7F;
  run(2s);
  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_EQ(sent_count(nmt({0x01, 0x05})), 1);
  EXPECT_TRUE(network->exchanges_pdos(0));
}

TEST_F(NetworkTest, LeavesANodeWhereAnApplicationHasPutIt) {
  add_drive();
  start();
  run(200ms);
  sent.clear();
  network->submit(
      {.id = 1, .kind = RequestKind::nmt, .node = 5, .command = NmtCommand::enter_preoperational},
      now);
  run(5s);
  EXPECT_EQ(sent.size(), 1U);
  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_EQ(status().nmt, NmtState::preoperational);
}

TEST_F(NetworkTest, OnlyWatchesANodeThatIsNotBooted) {
  add_drive().boot = false;
  start();
  run(200ms);
  EXPECT_TRUE(sent.empty());
  EXPECT_EQ(status().boot, BootState::idle);
  EXPECT_EQ(status().nmt, NmtState::preoperational);
  device().on = false;
  run(200ms);
  EXPECT_EQ(count(EventKind::heartbeat_lost), 1);
  device().on = true;
  run(100ms);
  EXPECT_EQ(count(EventKind::heartbeat_back), 1);
}

TEST_F(NetworkTest, SaysNothingWhileItObserves) {
  plan.master_heartbeat = 100ms;
  add_drive();
  start({.observe = true});
  ASSERT_TRUE(network->submit(read(1, {0x1000, 0}), now));
  run(1s);
  hear(heartbeat(0x00));
  hear(make_frame(CobId::base(0x85), {0x30, 0x81, 0x11}));
  run(1s);
  EXPECT_TRUE(sent.empty());
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].fault, SdoFault::refused);
  EXPECT_EQ(status().last_emcy, 0x8130);
}

TEST_F(NetworkTest, ProducesTheHeartbeatOfTheMaster) {
  plan.master_heartbeat = 100ms;
  start();
  run(250ms);
  const CobId id = CobId::base(0x77F);
  EXPECT_EQ(sent, (std::vector<Frame>{make_frame(id, {0x00}), make_frame(id, {0x05}),
                                      make_frame(id, {0x05})}));
  EXPECT_EQ(network->deadline(), 10300ms);
}

// EMCY

TEST_F(NetworkTest, ReportsAnEmcyWithItsBytes) {
  add_drive();
  start();
  hear(make_frame(CobId::base(0x85), {0x10, 0x73, 0x21, 1, 2, 3, 4, 5}));
  ASSERT_EQ(count(EventKind::emcy), 1);
  EXPECT_EQ(find(EventKind::emcy)->node, 5);
  EXPECT_EQ(find(EventKind::emcy)->bytes,
            (std::array<std::uint8_t, 8>{0x10, 0x73, 0x21, 1, 2, 3, 4, 5}));
  EXPECT_EQ(status().last_emcy, 0x7310);
  EXPECT_EQ(status().error_register, 0x21);
  EXPECT_EQ(status().emcy_count, 1U);
}

TEST_F(NetworkTest, TakesAnEmcyOfOneByteForNoErrorCode) {
  add_drive();
  start();
  hear(make_frame(CobId::base(0x85), {0x10, 0x73, 0x21, 1, 2, 3, 4, 5}));
  hear(make_frame(CobId::base(0x85), {0x11}));
  ASSERT_EQ(count(EventKind::emcy), 2);
  EXPECT_EQ(events.back().detail, 1U);
  EXPECT_EQ(status().last_emcy, 0x7310) << "what was told before stands";
  EXPECT_EQ(status().error_register, 0x21);
  EXPECT_EQ(status().emcy_count, 2U);
}

TEST_F(NetworkTest, KeepsTheErrorRegisterThatAShortEmcyDoesNotReport) {
  add_drive();
  start();
  hear(make_frame(CobId::base(0x85), {0x10, 0x73, 0x21, 1, 2, 3, 4, 5}));
  hear(make_frame(CobId::base(0x85), {0x20, 0x43}));
  EXPECT_EQ(status().last_emcy, 0x4320);
  EXPECT_EQ(status().error_register, 0x21);
}

TEST_F(NetworkTest, TakesAFrameWithoutBytesForNoEmcy) {
  add_drive();
  start();
  hear(make_frame(CobId::base(0x85), {0x10, 0x73, 0x21, 1, 2, 3, 4, 5}));
  hear(make_frame(CobId::base(0x85), {}));
  EXPECT_EQ(count(EventKind::emcy), 1);
  EXPECT_EQ(status().last_emcy, 0x7310);
  EXPECT_EQ(status().error_register, 0x21);
  EXPECT_EQ(status().emcy_count, 1U);
}

TEST_F(NetworkTest, CountsAFloodOfEmcysButReportsOnlySome) {
  add_drive();
  start();
  for (int i = 0; i < 1000; ++i) hear(make_frame(CobId::base(0x85), {0x10, 0x73, 0x21}));
  EXPECT_EQ(status().emcy_count, 1000U);
  EXPECT_EQ(count(EventKind::emcy), 10);
  now += 1s;
  hear(make_frame(CobId::base(0x85), {0x10, 0x73, 0x21}));
  EXPECT_EQ(events.back().value, 990);
}

/// Some stacks report EMCY 8240 for a SYNC that comes before the write of 0x1019, and then refuse
/// to start until the next reset.
TEST_F(NetworkTest, BootsANodeOnceMoreThatMetTheCounterOfSyncTooEarly) {
  NodePlan& drive = add_drive();
  drive.mandatory = true;
  drive.boot_plan.steps.push_back(
      {.action = BootAction::await_operational, .letter = 'K', .timeout = 300ms});
  device().starts = false;
  start();
  run(100ms);
  device().say(now, 0x80, {0x40, 0x82, 0x11, 0, 0, 0, 0, 0});
  for (int i = 0; i < 1000 && device().resets < 2; ++i) run(1ms);
  device().starts = true;
  run(500ms);
  EXPECT_EQ(device().resets, 2);
  EXPECT_EQ(count(EventKind::boot_failed), 0);
  EXPECT_EQ(count(EventKind::boot_done), 1);
}

TEST_F(NetworkTest, StopsInTheMiddleOfABoot) {
  add_drive();
  start();
  run(21ms);
  network->begin_stop(now);
  run(2ms);
  EXPECT_TRUE(network->stopped());
  run(5s);
  EXPECT_EQ(status().boot, BootState::idle);
}

}  // namespace
}  // namespace takt
