// Limits of a drive that are read in its boot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/master/core/node/boot_rig.hpp"

namespace takt {
namespace {

constexpr ObjectKey lowest{0x607D, 1};
constexpr ObjectKey highest{0x607D, 2};

Steps reading() {
  Steps steps;
  steps.nmt(NmtCommand::reset_communication)
      .wait(BootAction::await_bootup, 'B', 1s)
      .object(BootAction::probe, 'B', {0x1000, 0})
      .object(BootAction::read_limit, 'J', lowest)
      .object(BootAction::read_limit, 'J', highest)
      .nmt(NmtCommand::start);
  return steps;
}

std::vector<std::pair<ObjectKey, std::uint32_t>> read_by(const Network& network) {
  std::vector<std::pair<ObjectKey, std::uint32_t>> values;
  for (const LimitReading& reading : network.limits_read(0)) {
    values.emplace_back(reading.object, reading.value);
  }
  return values;
}

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

TEST_F(Boot, ReadsLimitsOfTheDrive) {
  prepare = [](FakeNode& device) {
    device.objects[lowest] = bytes({0x18, 0xFC, 0xFF, 0xFF});
    device.objects[highest] = bytes({0xD0, 0x07, 0x00, 0x00});
  };
  boot(reading());

  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_THAT(read_by(*network), ElementsAre(Pair(lowest, 0xFFFF'FC18U), Pair(highest, 2000U)));
}

TEST_F(Boot, DoesNotComplainOfADriveWithoutLimits) {
  prepare = [](FakeNode& device) {
    device.read_aborts[lowest] = 0x0602'0000;
    device.objects[highest] = bytes({0xD0, 0x07});  // not 32 bits
  };
  boot(reading());

  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_EQ(count(EventKind::boot_failed), 0);
  EXPECT_THAT(read_by(*network), IsEmpty());
}

TEST_F(Boot, ReadsAQuickStopOptionCodeOf16Bits) {
  const ObjectKey second_axis{0x685A, 0};
  Steps steps;
  steps.object(BootAction::read_limit, 'J', {0x605A, 0})
      .object(BootAction::read_limit, 'J', second_axis)
      .nmt(NmtCommand::start);
  prepare = [&](FakeNode& device) {
    device.objects[{0x605A, 0}] = bytes({0x00, 0x00});
    device.objects[second_axis] = bytes({0x02, 0x00, 0x00, 0x00});  // not 16 bits
  };
  boot(std::move(steps));

  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_THAT(read_by(*network), ElementsAre(Pair(ObjectKey{0x605A, 0}, 0U)));
}

TEST_F(Boot, ReadsLimitsAnewWhenTheDriveComesBack) {
  prepare = [](FakeNode& device) {
    device.objects[lowest] = bytes({0x18, 0xFC, 0xFF, 0xFF});
    device.objects[highest] = bytes({0xD0, 0x07, 0x00, 0x00});
  };
  boot(reading());
  device().objects[highest] = bytes({0xB8, 0x0B, 0x00, 0x00});
  device().read_aborts[lowest] = 0x0602'0000;
  device().say(now + 1ms, 0x700, {0x00});
  run(5s);

  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_EQ(status().boot_count, 2U);
  EXPECT_THAT(read_by(*network), ElementsAre(Pair(highest, 3000U)));
}

TEST_F(Boot, ReadsLimitsOfADriveThatIsLeftRunning) {
  Steps steps;
  steps.add({.action = BootAction::await_alive, .letter = 'E', .target = 3, .timeout = 200ms})
      .nmt(NmtCommand::reset_communication)
      .wait(BootAction::await_bootup, 'B', 1s)
      .object(BootAction::read_limit, 'J', highest)
      .nmt(NmtCommand::start);
  prepare = [this](FakeNode& device) {
    device.objects[highest] = bytes({0xD0, 0x07, 0x00, 0x00});
    device.state = 5;
    device.heartbeats(now, 50ms);
  };
  boot(std::move(steps));

  EXPECT_EQ(device().resets, 0);
  EXPECT_EQ(status().boot, BootState::ready);
  EXPECT_THAT(read_by(*network), ElementsAre(Pair(highest, 2000U)));
}

}  // namespace
}  // namespace takt
