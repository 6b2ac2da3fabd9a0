#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/takt/import/import_report.hpp"
#include "test/unit/apps/takt/import/import_fixture.hpp"

namespace takt {
namespace {

using test::Import;
using testing::HasSubstr;

TEST_F(Import, GuardingBesideAHeartbeatIsIgnored) {
  const auto bus = report(
      "master: {sync_period: 10000}\n"
      "arm: {node_id: 2, dcf: drive.eds, guard_time: 100, life_time_factor: 3, retry_factor: 2}\n");

  EXPECT_TRUE(bus.usable);
  for (const auto* path : {"arm.guard_time", "arm.life_time_factor", "arm.retry_factor"}) {
    EXPECT_EQ(key(bus, path).use, KeyUse::ignored) << path;
    EXPECT_THAT(key(bus, path).why, HasSubstr("has a heartbeat")) << path;
  }
}

TEST_F(Import, GuardingThatTheDeviceCannotTakeIsSuspicious) {
  const auto bus = report(
      "master: {sync_period: 10000}\n"
      "arm: {node_id: 2, dcf: drive.eds, heartbeat_producer: 0, guard_time: 100,\n"
      "      life_time_factor: 3, retry_factor: 2}\n");

  EXPECT_TRUE(bus.usable);
  EXPECT_EQ(key(bus, "arm.guard_time").use, KeyUse::used);
  EXPECT_THAT(key(bus, "arm.guard_time").why, HasSubstr("has no writable 100C:00"));
  EXPECT_EQ(key(bus, "arm.life_time_factor").use, KeyUse::suspicious);
  EXPECT_THAT(key(bus, "arm.life_time_factor").why, HasSubstr("will not watch the master"));
  EXPECT_EQ(key(bus, "arm.retry_factor").use, KeyUse::used);
}

TEST_F(Import, GuardingByDefaultIsUsedWhereOneNodeTakesIt) {
  const auto bus = report(
      "master: {sync_period: 10000}\n"
      "defaults: {dcf: drive.eds, guard_time: 100}\n"
      "nodes: {arm: {node_id: 2}, leg: {node_id: 3, heartbeat_producer: 0}}\n");

  EXPECT_EQ(key(bus, "defaults.guard_time").use, KeyUse::used);
  EXPECT_THAT(key(bus, "defaults.guard_time").why, HasSubstr("without heartbeat; but"));
  EXPECT_THAT(key(bus, "defaults.guard_time").why, HasSubstr("`arm` has a heartbeat"));
}

TEST_F(Import, TheRetryFactorOfAllIsUsedOnlyWhereANodeIsGuardedByIt) {
  const auto fate = [this](const std::string& keys) {
    const auto bus = report(
        "options: {retry_factor: 3}\nmaster: {sync_period: 10000}\n"
        "arm: {node_id: 2, dcf: drive.eds" +
        keys + "}\n");
    const auto& row = key(bus, "options.retry_factor");
    return std::string{name(row.use)} + ": " + row.why;
  };

  EXPECT_THAT(fate(""),
              HasSubstr("ignored: `retry_factor` of `options` has no effect: no node is"));
  EXPECT_THAT(fate(", heartbeat_producer: 0, guard_time: 100, retry_factor: 2"),
              HasSubstr("ignored: `retry_factor` of `options` has no effect: each guarded node"));
  EXPECT_EQ(fate(", heartbeat_producer: 0, guard_time: 100"),
            "used: The accepted silence, in guard times. 0: the master does not guard");
}

}  // namespace
}  // namespace takt
