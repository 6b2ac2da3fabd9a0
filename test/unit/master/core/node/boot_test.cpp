#include <gtest/gtest.h>

#include "test/unit/master/core/node/boot_rig.hpp"

namespace takt {
namespace {

TEST_F(Boot, IsThisConversation) {
  Steps steps;
  steps.nmt(NmtCommand::reset_communication)
      .wait(BootAction::await_bootup, 'B', 1s)
      .object(BootAction::probe, 'B', {0x1000, 0})
      .object(BootAction::expect, 'D', {0x1018, 1}, bytes({0x5A, 0x01, 0x00, 0x00}))
      .object(BootAction::disable_pdo, 'J', {0x1800, 1})
      .object(BootAction::write, 'J', {0x1A00, 0}, bytes({0}))
      .object(BootAction::write, 'J', {0x1A00, 1}, bytes({0x10, 0x00, 0x41, 0x60}))
      .object(BootAction::write, 'J', {0x1A00, 2}, bytes({0x20, 0x00, 0x64, 0x60}))
      .object(BootAction::write, 'J', {0x1A00, 0}, bytes({2}))
      .object(BootAction::write_if_differs, 'J', {0x1800, 2}, bytes({1}))
      .object(BootAction::enable_pdo, 'J', {0x1800, 1}, bytes({0x85, 0x01, 0x00, 0x00}))
      .object(BootAction::write, 'J', {0x1017, 0}, bytes({0xE8, 0x03}))
      .nmt(NmtCommand::start);
  boot(std::move(steps));

  const std::vector<Frame> expected{
      nmt({0x82, 0x05}),
      heartbeat(0x00),
      tx({0x40, 0x00, 0x10, 0x00}),
      rx({0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00}),
      tx({0x40, 0x18, 0x10, 0x01}),
      rx({0x43, 0x18, 0x10, 0x01, 0x5A, 0x01, 0x00, 0x00}),
      tx({0x40, 0x00, 0x18, 0x01}),
      rx({0x43, 0x00, 0x18, 0x01, 0x85, 0x01, 0x00, 0x40}),
      nmt({0x80, 0x05}),  // PRE-OPERATIONAL, before the first write
      tx({0x23, 0x00, 0x18, 0x01, 0x85, 0x01, 0x00, 0xC0}),
      rx({0x60, 0x00, 0x18, 0x01}),
      tx({0x2F, 0x00, 0x1A, 0x00, 0x00}),
      rx({0x60, 0x00, 0x1A, 0x00}),
      tx({0x23, 0x00, 0x1A, 0x01, 0x10, 0x00, 0x41, 0x60}),
      rx({0x60, 0x00, 0x1A, 0x01}),
      tx({0x23, 0x00, 0x1A, 0x02, 0x20, 0x00, 0x64, 0x60}),
      rx({0x60, 0x00, 0x1A, 0x02}),
      tx({0x2F, 0x00, 0x1A, 0x00, 0x02}),
      rx({0x60, 0x00, 0x1A, 0x00}),
      tx({0x40, 0x00, 0x18, 0x02}),
      rx({0x4F, 0x00, 0x18, 0x02, 0xFF}),
      tx({0x2F, 0x00, 0x18, 0x02, 0x01}),
      rx({0x60, 0x00, 0x18, 0x02}),
      tx({0x23, 0x00, 0x18, 0x01, 0x85, 0x01, 0x00, 0x40}),
      rx({0x60, 0x00, 0x18, 0x01}),
      tx({0x2B, 0x17, 0x10, 0x00, 0xE8, 0x03}),
      rx({0x60, 0x17, 0x10, 0x00}),
      nmt({0x01, 0x05}),
  };
  EXPECT_EQ(log, expected);
  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_EQ(status().boot_count, 1U);
  EXPECT_TRUE(network->exchanges_pdos(0));
  EXPECT_EQ(network->deadline(), never);
}

TEST_F(Boot, WritesNothingWhereTheDeviceIsRightAlready) {
  prepare = [](FakeNode& node) { node.objects[{0x1A00, 0}] = bytes({2}); };
  boot(tpdo1());
  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_TRUE(device().writes.empty());
}

TEST_F(Boot, ReconfiguresInTheOrderThatDevicesAccept) {
  boot(tpdo1());
  EXPECT_EQ(status().boot, BootState::ready);
  const std::vector<ObjectKey> order{
      {0x1800, 1}, {0x1A00, 0}, {0x1A00, 1}, {0x1A00, 0}, {0x1800, 1}};
  EXPECT_EQ(device().writes, order);
  EXPECT_EQ(device().objects[(ObjectKey{0x1800, 1})], bytes({0x85, 0x01, 0x00, 0x40}));
}

TEST_F(Boot, LeavesADisabledPdoAsItIs) {
  prepare = [](FakeNode& node) { node.objects[{0x1800, 1}] = bytes({0x85, 0x01, 0x00, 0x80}); };
  Steps steps;
  steps.object(BootAction::disable_pdo, 'J', {0x1800, 1});
  boot(std::move(steps));
  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_TRUE(device().writes.empty());
}

TEST_F(Boot, AcceptsANodeThatNeverSaysBootUp) {
  prepare = [](FakeNode& node) { node.says_bootup = false; };
  Steps steps;
  steps.nmt(NmtCommand::reset_node)
      .wait(BootAction::await_bootup, 'B', 2s)
      .object(BootAction::probe, 'B', {0x1000, 0})
      .nmt(NmtCommand::start);
  boot(std::move(steps));
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(Boot, WaitsForOperationalByHeartbeat) {
  prepare = [this](FakeNode& node) { node.heartbeats(now, 50ms); };
  Steps steps;
  steps.nmt(NmtCommand::start).wait(BootAction::await_operational, 'L', 300ms);
  boot(std::move(steps), 200ms);
  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_EQ(status().nmt, NmtState::operational);
}

TEST_F(Boot, TakesANodeWithoutHeartbeatAsStartedAfterTheWait) {
  Steps steps;
  steps.nmt(NmtCommand::start).wait(BootAction::await_operational, 'L', 300ms);
  boot(std::move(steps), 299ms);
  EXPECT_EQ(status().boot, BootState::booting);
  run(1ms);
  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_TRUE(network->exchanges_pdos(0));
}

TEST_F(Boot, ReportsWhenANodeWasOperationalAlready) {
  Steps steps;
  steps.object(BootAction::probe, 'B', {0x1000, 0});
  add(5, std::move(steps.plan));
  device().objects = identity;
  network = std::make_unique<Network>(plan);
  hear(heartbeat(0x05));
  network->start(now);
  run(500ms);
  ASSERT_NE(find(EventKind::boot_done), nullptr);
  EXPECT_EQ(find(EventKind::boot_done)->value, 1);
  EXPECT_TRUE(network->exchanges_pdos(0));
}

// Tolerance.

TEST_F(Boot, RepeatsUploadsThatGetNoAnswer) {
  prepare = [](FakeNode& node) { node.swallow = 2; };
  Steps steps;
  steps.object(BootAction::expect, 'D', {0x1018, 1}, bytes({0x5A, 0x01, 0x00, 0x00}));
  boot(std::move(steps));
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(Boot, LooksWhetherAnUnansweredWriteHasWorkedInsteadOfRepeatingIt) {
  prepare = [](FakeNode& node) { node.swallow = 1; };
  Steps steps;
  steps.object(BootAction::write, 'J', {0x2000, 0}, bytes({5}));
  boot(std::move(steps), 500ms);
  EXPECT_EQ(device().writes.size(), 1U);
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(Boot, TakesAnswersLongerAndShorterThanTheEdsSays) {
  prepare = [](FakeNode& node) {
    node.objects[{0x2000, 0}] = bytes({0x05, 0x00, 0x12, 0x34});  // wanted: two bytes
    node.objects[{0x2001, 0}] = bytes({0x05});                    // wanted: four bytes
    node.objects[{0x2002, 0}] = bytes({'t', 'a', 'k', 't', '!', 0});
  };
  Steps steps;
  steps.object(BootAction::expect, 'J', {0x2000, 0}, bytes({0x05, 0x00}))
      .object(BootAction::expect, 'J', {0x2001, 0}, bytes({0x05, 0, 0, 0}))
      .object(BootAction::expect, 'J', {0x2002, 0}, bytes({'t', 'a', 'k', 't', '!'}));
  boot(std::move(steps));
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(Boot, ComparesUnderTheMask) {
  Steps steps;
  steps.add({.action = BootAction::expect,
             .letter = 'N',
             .object = {0x1018, 3},
             .value = bytes({0x99, 0x99, 0x01, 0x00}),
             .mask = 0xFFFF'0000,
             .timeout = 100ms});
  boot(std::move(steps));
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(Boot, ProbesUntilABusyDeviceIsReady) {
  prepare = [](FakeNode& node) { node.read_aborts[{0x1000, 0}] = 0x08000022; };
  Steps steps;
  steps.add({.action = BootAction::probe, .letter = 'B', .object = {0x1000, 0}, .timeout = 3s});
  boot(std::move(steps), 500ms);
  EXPECT_EQ(status().boot, BootState::booting);
  device().read_aborts.clear();
  run(100ms);
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(Boot, TakesAnyOtherAbortOfAProbeAsASignOfLife) {
  Steps steps;
  steps.object(BootAction::probe, 'B', {0x1F00, 0});
  boot(std::move(steps), 500ms);
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(Boot, HurriesWhenTheBootUpMessageComesDuringTheProbe) {
  prepare = [this](FakeNode& node) {
    node.mute_sdo = true;
    node.say(now + 600ms, 0x700, {0x00});
  };
  Steps steps;
  steps.wait(BootAction::await_bootup, 'B', 100ms);
  steps.add({.action = BootAction::probe, .letter = 'B', .object = {0x1000, 0}, .timeout = 3s});
  boot(std::move(steps), 599ms);
  device().mute_sdo = false;
  run(10ms);
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(Boot, BeginsAnewWithoutResetWhenTheNodeRestartsInIt) {
  prepare = [this](FakeNode& node) { node.say(now + 12ms, 0x700, {0x00}); };
  Steps steps;
  steps.object(BootAction::probe, 'B', {0x1000, 0});
  for (int i = 0; i < 20; ++i) steps.object(BootAction::write, 'J', {0x2000, 0}, bytes({1}));
  boot(std::move(steps));
  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_EQ(device().resets, 0);
  EXPECT_GT(device().writes.size(), 20U);
  EXPECT_EQ(count(EventKind::boot_started), 1);
}

}  // namespace
}  // namespace takt
