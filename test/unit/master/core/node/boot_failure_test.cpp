#include <gtest/gtest.h>

#include "test/unit/master/core/node/boot_rig.hpp"

namespace takt {
namespace {

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

TEST_F(Boot, OfAnotherDeviceOnlyReadsItsIdentityUntilTheRightDeviceIsThere) {
  const auto right = bytes({0x5A, 0x01, 0x00, 0x00});
  Steps steps;
  steps.nmt(NmtCommand::reset_communication)
      .wait(BootAction::await_bootup, 'B', 500ms)
      .object(BootAction::expect, 'D', {0x1018, 1}, right)
      .object(BootAction::write, 'J', {0x2000, 0}, bytes({5}));
  identity[{0x1018, 1}] = bytes({0x99, 0x09, 0x00, 0x00});
  boot(std::move(steps), 5s);
  EXPECT_EQ(failure().letter, 'D');
  EXPECT_EQ(device().resets, 1);
  EXPECT_TRUE(device().writes.empty());

  device().objects[{0x1018, 1}] = right;
  run(2s);
  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_EQ(device().resets, 2);  // The whole boot has run.
  EXPECT_EQ(device().writes.size(), 1U);
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

TEST_F(Boot, GivesUpAnUploadAfterThreeAttempts) {
  prepare = [](FakeNode& node) { node.mute_sdo = true; };
  Steps steps;
  steps.object(BootAction::expect, 'D', {0x1018, 1}, bytes({0x5A, 0x01, 0x00, 0x00}));
  boot(std::move(steps), 500ms);
  EXPECT_EQ(failure().fault, SdoFault::timeout);
  EXPECT_EQ(failure().attempts, 3);
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
  EXPECT_EQ(status().boot, BootState::failed);  // a boot-up message starts no new boot
}

TEST_F(Boot, DoesNotLoopOverATargetThatPointsBack) {
  Steps steps;
  steps.skip(0).skip(0).skip(9999);
  boot(std::move(steps), 1ms);
  EXPECT_EQ(status().boot, BootState::ready);
}

}  // namespace
}  // namespace takt
