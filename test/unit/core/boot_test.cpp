#include <functional>
#include <gtest/gtest.h>
#include <map>

#include "test/unit/core/network_rig.hpp"

namespace takt {
namespace {

class Boot : public testing::Test, public NetworkRig {
 protected:
  /// Boots node 5 with one plan; the device has a drive's identity unless it was changed.
  void boot(Steps steps, Time span = 5s) {
    add(5, std::move(steps.plan));
    for (const auto& [key, value] : identity) device().objects.try_emplace(key, value);
    if (prepare) prepare(device());
    start();
    run(span);
  }
  const BootFailure& failure() {
    const Event* event = find(EventKind::boot_failed);
    if (event == nullptr) {
      ADD_FAILURE() << "the boot did not fail";
      static const BootFailure none;
      return none;
    }
    return event->failure;
  }

  std::map<ObjectKey, FakeNode::Bytes> identity{
      {{0x1000, 0}, bytes({0x92, 0x01, 0x02, 0x00})},
      {{0x1018, 1}, bytes({0x5A, 0x01, 0x00, 0x00})},
      {{0x1018, 2}, bytes({0x01, 0x00, 0x00, 0x00})},
      {{0x1018, 3}, bytes({0x02, 0x00, 0x01, 0x00})},
      {{0x1018, 4}, bytes({0x2A, 0x00, 0x00, 0x00})},
      {{0x1800, 1}, bytes({0x85, 0x01, 0x00, 0x40})},
      {{0x1800, 2}, bytes({0xFF})},
      {{0x1A00, 0}, bytes({0x00})},
      {{0x1017, 0}, bytes({0x00, 0x00})},
  };
  std::function<void(FakeNode&)> prepare;
};

Steps tpdo1() {
  Steps steps;
  steps.object(BootAction::compare, 'J', {0x1800, 1}, bytes({0x85, 0x01, 0x00, 0x40}))
      .object(BootAction::compare, 'J', {0x1A00, 0}, bytes({2}))
      .skip(9)
      .object(BootAction::disable_pdo, 'J', {0x1800, 1})
      .object(BootAction::write, 'J', {0x1A00, 0}, bytes({0}))
      .object(BootAction::write, 'J', {0x1A00, 1}, bytes({0x10, 0x00, 0x41, 0x60}))
      .object(BootAction::write, 'J', {0x1A00, 0}, bytes({2}))
      .object(BootAction::enable_pdo, 'J', {0x1800, 1}, bytes({0x85, 0x01, 0x00, 0x00}))
      .object(BootAction::verify, 'J', {0x1A00, 0}, bytes({2}));
  return steps;
}

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

// One failure for every letter that a boot plan can carry.

TEST_F(Boot, FailsWithBWhenTheNodeIsMute) {
  prepare = [](FakeNode& node) { node.on = false; };
  Steps steps;
  steps.nmt(NmtCommand::reset_communication).wait(BootAction::await_bootup, 'B', 500ms);
  steps.add({.action = BootAction::probe, .letter = 'B', .object = {0x1000, 0}, .timeout = 2s});
  boot(std::move(steps), 2700ms);
  EXPECT_EQ(failure().letter, 'B');
  EXPECT_EQ(failure().step, 2);
  EXPECT_EQ(failure().fault, SdoFault::timeout);
  EXPECT_FALSE(failure().bootup_seen);
  EXPECT_EQ(failure().received_size, 0);
  EXPECT_EQ(failure().elapsed, 2500ms);
  EXPECT_EQ(status().boot, BootState::failed);
  EXPECT_FALSE(network->exchanges_pdos(0));
}

TEST_F(Boot, FailsWithTheLetterOfTheIdentityThatDiffers) {
  const struct {
    char letter;
    ObjectKey object;
  } cases[] = {{'C', {0x1000, 0}},
               {'D', {0x1018, 1}},
               {'M', {0x1018, 2}},
               {'N', {0x1018, 3}},
               {'O', {0x1018, 4}}};
  for (const auto& [letter, object] : cases) {
    NetworkRig rig;
    Steps steps;
    steps.object(BootAction::expect, letter, object, bytes({0x99, 0x09, 0x00, 0x00}));
    rig.add(5, std::move(steps.plan));
    rig.device().objects[object] = bytes({0x34, 0x12, 0x00, 0x00});
    rig.start();
    rig.run(500ms);
    const Event* event = rig.find(EventKind::boot_failed);
    ASSERT_NE(event, nullptr) << letter;
    EXPECT_EQ(event->failure.letter, letter);
    EXPECT_EQ(event->failure.fault, SdoFault::none);
    EXPECT_EQ(event->failure.value_size, 4);
    EXPECT_EQ(event->failure.value[0], 0x34);
    EXPECT_EQ(event->failure.object, object);
  }
}

TEST_F(Boot, FailsWithEWhenANodeToKeepAliveIsSilent) {
  Steps steps;
  steps.wait(BootAction::await_heartbeat, 'E', 300ms);
  boot(std::move(steps), 500ms);
  EXPECT_EQ(failure().letter, 'E');
  EXPECT_EQ(failure().sent_size, 0);
}

TEST_F(Boot, FailsWithJAndTheAbortCodeWhenAMappingIsRefused) {
  prepare = [](FakeNode& node) { node.write_aborts[{0x1A00, 1}] = 0x06040041; };
  boot(tpdo1(), 500ms);
  EXPECT_EQ(failure().letter, 'J');
  EXPECT_EQ(failure().step, 5);
  EXPECT_TRUE(failure().downloading);
  EXPECT_EQ(failure().fault, SdoFault::aborted_by_device);
  EXPECT_EQ(failure().abort_code, 0x06040041U);
  EXPECT_EQ(failure().sent, (std::array<std::uint8_t, 8>{0x23, 0, 0x1A, 1, 0x10, 0, 0x41, 0x60}));
  EXPECT_EQ(failure().received,
            (std::array<std::uint8_t, 8>{0x80, 0, 0x1A, 1, 0x41, 0, 0x04, 0x06}));
  EXPECT_EQ(status().sdo_aborts, 1U);
}

TEST_F(Boot, FailsWithJWhenAnAcceptedValueReadsBackOtherwise) {
  Steps steps;
  steps.object(BootAction::write, 'J', {0x2000, 0}, bytes({5}))
      .object(BootAction::verify, 'J', {0x2001, 0}, bytes({5}));
  prepare = [](FakeNode& node) { node.objects[{0x2001, 0}] = bytes({4}); };
  boot(std::move(steps), 500ms);
  EXPECT_EQ(failure().step, 1);
  EXPECT_EQ(failure().fault, SdoFault::none);
}

TEST_F(Boot, FailsWithKWhenNoHeartbeatComes) {
  Steps steps;
  steps.object(BootAction::write, 'J', {0x1017, 0}, bytes({100, 0}))
      .wait(BootAction::await_heartbeat, 'K', 300ms);
  boot(std::move(steps), 500ms);
  EXPECT_EQ(failure().letter, 'K');
  EXPECT_EQ(failure().fault, SdoFault::timeout);
}

TEST_F(Boot, FailsWhenTheNodeDoesNotBecomeOperational) {
  prepare = [this](FakeNode& node) {
    node.starts = false;
    node.heartbeats(now, 50ms);
  };
  Steps steps;
  steps.object(BootAction::probe, 'B', {0x1000, 0})
      .wait(BootAction::await_heartbeat, 'K', 300ms)
      .nmt(NmtCommand::start)
      .wait(BootAction::await_operational, 'L', 300ms);
  boot(std::move(steps), 500ms);
  EXPECT_EQ(failure().letter, 'L');
  EXPECT_EQ(failure().node_state, NmtState::preoperational);
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

TEST_F(Boot, TellsWhenANodeWasOperationalAlready) {
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

TEST_F(Boot, GivesUpAnUploadAfterThreeAttempts) {
  prepare = [](FakeNode& node) { node.mute_sdo = true; };
  Steps steps;
  steps.object(BootAction::expect, 'D', {0x1018, 1}, bytes({0x5A, 0x01, 0x00, 0x00}));
  boot(std::move(steps), 500ms);
  EXPECT_EQ(failure().fault, SdoFault::timeout);
  EXPECT_EQ(failure().attempts, 3);
}

TEST_F(Boot, LooksWhetherAnUnansweredWriteHasWorkedInsteadOfRepeatingIt) {
  prepare = [](FakeNode& node) { node.swallow = 1; };
  Steps steps;
  steps.object(BootAction::write, 'J', {0x2000, 0}, bytes({5}));
  boot(std::move(steps), 500ms);
  EXPECT_EQ(device().writes.size(), 1U);
  EXPECT_EQ(status().boot, BootState::ready);
}

TEST_F(Boot, NeverRepeatsADownload) {
  prepare = [](FakeNode& node) { node.mute_sdo = true; };
  Steps steps;
  steps.object(BootAction::write, 'J', {0x2000, 0}, bytes({5}));
  boot(std::move(steps), 500ms);
  EXPECT_EQ(device().writes.size(), 1U);
  EXPECT_EQ(failure().fault, SdoFault::timeout);
  EXPECT_TRUE(failure().downloading);
  EXPECT_EQ(failure().sent[0], 0x2F);
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

TEST_F(Boot, MissesAnOptionalObjectOnlyWhereItShouldBeZero) {
  prepare = [](FakeNode& node) {
    node.write_aborts[{0x1800, 5}] = 0x06090011;
    node.read_aborts[{0x1800, 5}] = 0x06090011;
  };
  const auto step = [](unsigned value) {
    Steps steps;
    steps.add({.action = BootAction::write,
               .object = {0x1800, 5},
               .value = bytes({value, 0}),
               .optional = true,
               .timeout = 100ms});
    return steps;
  };
  boot(step(0), 500ms);
  EXPECT_EQ(status().boot, BootState::ready);

  NetworkRig other;
  other.add(5, step(10).plan);
  other.device().write_aborts[{0x1800, 5}] = 0x06090011;
  other.start();
  other.run(500ms);
  ASSERT_NE(other.find(EventKind::boot_failed), nullptr);
  EXPECT_EQ(other.find(EventKind::boot_failed)->failure.abort_code, 0x06090011U);
  EXPECT_TRUE(other.find(EventKind::boot_failed)->failure.downloading);
}

TEST_F(Boot, ForgivesARefusedWriteOnlyWhereTheValueIsThereAlready) {
  const auto rig = [](unsigned there) {
    auto out = std::make_unique<NetworkRig>();
    Steps steps;
    steps.add({.action = BootAction::write,
               .object = {0x1A00, 0},
               .value = bytes({2}),
               .optional = true,
               .timeout = 100ms});
    out->add(5, std::move(steps.plan));
    out->device().objects[{0x1A00, 0}] = bytes({there});
    out->device().write_aborts[{0x1A00, 0}] = 0x06010002;
    out->start();
    out->run(500ms);
    return out;
  };
  EXPECT_EQ(rig(2)->status().boot, BootState::ready);

  const auto refused = rig(3);
  ASSERT_NE(refused->find(EventKind::boot_failed), nullptr);
  EXPECT_EQ(refused->find(EventKind::boot_failed)->failure.abort_code, 0x06010002U);
  EXPECT_EQ(refused->find(EventKind::boot_failed)->failure.sent[0], 0x2F);
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

TEST_F(Boot, EndsForANodeThatRestartsAgainAndAgain) {
  prepare = [this](FakeNode& node) {
    for (int i = 1; i < 400; ++i) node.say(now + i * 5ms, 0x700, {0x00});
  };
  Steps steps;
  steps.object(BootAction::probe, 'B', {0x1000, 0});
  for (int i = 0; i < 20; ++i) steps.object(BootAction::write, 'J', {0x2000, 0}, bytes({1}));
  boot(std::move(steps), 500ms);
  EXPECT_EQ(failure().fault, SdoFault::cancelled);
  EXPECT_EQ(failure().restarts, 6);
  EXPECT_EQ(status().boot, BootState::failed);  // not begun again by each of its boot-up messages
}

TEST_F(Boot, DoesNotLoopOverATargetThatPointsBack) {
  Steps steps;
  steps.skip(0).skip(0).skip(9999);
  boot(std::move(steps), 1ms);
  EXPECT_EQ(status().boot, BootState::ready);
}

}  // namespace
}  // namespace takt
