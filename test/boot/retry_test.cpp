#include "test/boot/plant.hpp"

// The times at which the master repeats a failed boot.

namespace takt {
namespace {

using namespace test;
using enum sim::FaultKind;

sim::Fault of_valve(sim::FaultKind kind, Time at = {}, Time until = never) {
  return {.kind = kind, .node = 5_node, .at = at, .until = until};
}

/// A fault that makes the device show another vendor-ID.
sim::Fault another_vendor(Time until = never) {
  sim::Fault out = of_valve(override_value, {}, until);
  out.object = ObjectKey{0x1018, 1};
  out.value = {std::byte{0x43}, std::byte{0}, std::byte{0}, std::byte{0}};
  return out;
}

/// Records the times of the frames with this identifier and first byte.
struct Times final : sim::BusObserver {
  explicit Times(std::uint32_t cob_id, std::uint8_t first) : id{cob_id}, byte{first} {}
  void on_wire(const sim::WireFrame& seen) noexcept override {
    if (seen.frame.id.id() == id && seen.frame.data[0] == byte) at.push_back(seen.start);
  }
  std::uint32_t id;
  std::uint8_t byte;
  std::vector<Time> at;
};

TEST(Retry, PausesGrowToTheLongest) {
  Plant plant{valve("boot_timeout_ms: 100"), {of_valve(mute_sdo)}};
  Times resets{0x000, 0x82};
  plant.world.observe(&resets);
  plant.run(180s);
  // Each try takes 0.1 s and the pause: 1, 2, 4, 8, 16, 30, 30, 30, 30 s.
  ASSERT_GE(resets.at.size(), 10u);
  ASSERT_LE(resets.at.size(), 11u);
  for (std::size_t i = 0; i < 9; ++i) {
    const Time pause = std::min<Time>(1s * (1U << i), 30s);
    const Time gap = resets.at[i + 1] - resets.at[i];
    EXPECT_GE(gap, pause) << i;
    EXPECT_LE(gap, pause + 300ms) << i;
  }
}

TEST(Retry, BothPausesCanBeSet) {
  Plant plant{valve("boot_timeout_ms: 100, reboot_delay_ms: 500, reboot_delay_max_ms: 600"),
              {of_valve(mute_sdo)}};
  Times resets{0x000, 0x82};
  plant.world.observe(&resets);
  plant.run(7s);
  ASSERT_GE(resets.at.size(), 8u);
  EXPECT_LE(resets.at[3] - resets.at[2], 850ms);
}

TEST(Retry, BootUpMessageTriesAtOnce) {
  // The device is off for 100 s, long enough for pauses of 30 s.
  Plant plant{valve("boot_timeout_ms: 100, heartbeat_producer: 100"),
              {of_valve(power_off, {}, 100s)}};
  plant.run(100s);
  EXPECT_NE(plant.node().boot, BootState::ready);
  plant.run(2s);
  EXPECT_EQ(plant.node().boot, BootState::ready);
}

TEST(Retry, FirstHeartbeatOfANodeThatWasNotThereTriesAtOnce) {
  // The cable is plugged in: the device has power and a heartbeat, but sends no boot-up message.
  sim::Fault beats = of_valve(override_value);
  beats.object = ObjectKey{0x1017, 0};
  beats.value = {std::byte{100}, std::byte{0}};
  sim::Fault cut{.kind = loss, .node = 5_node, .until = 100s, .probability = 1.0};
  Plant plant{valve("reset: none, boot_timeout_ms: 100, heartbeat_producer: 100"), {beats, cut}};
  plant.run(100s);
  EXPECT_NE(plant.node().boot, BootState::ready);
  plant.run(3s);
  EXPECT_EQ(plant.node().boot, BootState::ready);
}

TEST(Retry, AnotherDeviceIsNotResetAgain) {
  Plant plant{valve(), {another_vendor()}};
  Times resets{0x000, 0x82};
  Times questions{0x605, 0x40};
  plant.world.observe(&resets);
  plant.run(100s);
  EXPECT_EQ(plant.node().boot_letter, 'D');
  EXPECT_EQ(resets.at.size(), 1u);
  plant.world.observe(&questions);
  plant.run(60s);
  EXPECT_GE(questions.at.size(), 2u) << "it is asked who it is";
  EXPECT_LE(questions.at.size(), 12u);
}

TEST(Retry, AnotherDeviceIsResetWhenSomebodyAsks) {
  Plant plant{valve(), {another_vendor()}};
  Times resets{0x000, 0x82};
  plant.world.observe(&resets);
  plant.run(50s);
  plant.nmt(NmtCommand::reset_communication, 5);
  plant.run(50s);
  EXPECT_GE(resets.at.size(), 2u);
  EXPECT_LE(resets.at.size(), 3u) << "the one that was asked for, and that of one boot";
}

TEST(Retry, TheRightDeviceIsBootedWithoutItsBootUpMessage) {
  // The right device replaces the wrong one, but the master does not receive its boot-up message.
  sim::Fault quiet = of_valve(no_bootup, 10s);
  Plant plant{valve("heartbeat_producer: 100"), {another_vendor(40s), quiet}};
  plant.run(39s);
  EXPECT_EQ(plant.node().boot_letter, 'D');
  plant.run(40s);
  EXPECT_EQ(plant.node().boot, BootState::ready);
}

TEST(Retry, ADeviceThatAnnouncesItselfIsTriedAtOnceWhateverWasThereBefore) {
  Plant plant{valve("heartbeat_producer: 100"),
              {another_vendor(40s), of_valve(power_off, 40s, 41s)}};
  plant.run(43s);
  EXPECT_EQ(plant.node().boot, BootState::ready);
}

}  // namespace
}  // namespace takt
