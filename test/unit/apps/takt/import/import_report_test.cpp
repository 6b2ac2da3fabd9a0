#include "apps/takt/import/import_report.hpp"

#include <cstdlib>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/apps/takt/import/import_fixture.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;
using test::Import;
using testing::HasSubstr;

TEST_F(Import, ADefaultThatEachNodeReplacesIsIgnored) {
  const auto bus = report(
      "defaults:\n"
      "  dcf: drive.eds\n"
      "  sdo: [{index: 0x6081, value: 1}]\n"
      "  tpdo: {2: {enabled: false}}\n"
      "nodes:\n"
      "  arm: {node_id: 2, sdo: [{index: 0x6083, value: 2}], tpdo: {1: {transmission: 1}}}\n"
      "  leg: {node_id: 3, sdo: [{index: 0x6083, value: 2}]}\n");

  EXPECT_TRUE(bus.usable);
  EXPECT_EQ(key(bus, "defaults.sdo[1]").use, KeyUse::ignored);
  EXPECT_THAT(key(bus, "defaults.sdo[1]").why, HasSubstr("each node has its own `sdo`"));
  EXPECT_EQ(key(bus, "defaults.tpdo.2.enabled").use, KeyUse::used);
  EXPECT_THAT(key(bus, "defaults.tpdo.2.enabled").why, HasSubstr("not for `arm`"));
  EXPECT_EQ(key(bus, "defaults.dcf").use, KeyUse::used);
}

TEST_F(Import, AnObjectTwiceInAListOrInAPdoIsSuspiciousAndRuns) {
  const auto bus = report(
      "arm:\n"
      "  node_id: 2\n"
      "  dcf: drive.eds\n"
      "  tpdo: {1: {transmission: 1, mapping: [{index: 0x6041}, {index: 0x6041}]}}\n"
      "  rpdo: {1: {transmission: 1, mapping: [{index: 0x6040}, {index: 0x6040}]}}\n"
      "  sdo: [{index: 0x6083, value: 1}, {index: 0x6083, value: 1}]\n");

  EXPECT_TRUE(bus.usable);
  EXPECT_EQ(key(bus, "arm.tpdo.1.mapping[2]").use, KeyUse::suspicious);
  EXPECT_THAT(key(bus, "arm.tpdo.1.mapping[2]").why, HasSubstr("a separate input"));
  EXPECT_EQ(key(bus, "arm.rpdo.1.mapping[2]").use, KeyUse::suspicious);
  EXPECT_THAT(key(bus, "arm.rpdo.1.mapping[2]").why, HasSubstr("both get the same value"));
  EXPECT_EQ(key(bus, "arm.sdo[2]").use, KeyUse::suspicious);
  EXPECT_THAT(key(bus, "arm.sdo[2]").why, HasSubstr("meant for another object?"));
}

/// Makes anchors, each of which contains the previous one eight times.

std::string bomb(char name, const std::string& first, bool maps) {
  std::string text = std::string{"  "} + name + "0: &" + name + "0 " + first + "\n";
  for (int level = 1; level < 20; ++level) {
    const std::string below = std::string{"*"} + name + std::to_string(level - 1);
    const std::string own = name + std::to_string(level);
    text += "  " + own + ": &" + own + (maps ? " {" : " [");
    for (int i = 0; i < 8; ++i) {
      text += (i == 0 ? "" : ", ") + (maps ? "k" + std::to_string(i) + ": " : "") + below;
    }
    text += maps ? "}\n" : "]\n";
  }
  return text;
}

TEST_F(Import, AliasesOfAliasesTakeNoTime) {
  const std::string head = "master: {node_id: 127}\n";
  const std::string tail = "nodes: {arm: {node_id: 5, dcf: drive.eds, x: ";

  const auto maps = report(".a:\n" + bomb('a', "{k: 1}", true) + bomb('b', "{k: 1}", true) + head +
                           "defaults: {x: *a19}\n" + tail + "*b19}}\n");
  const auto lists = report(".a:\n" + bomb('a', "[1, 2]", false) + bomb('b', "[1, 2]", false) +
                            head + "defaults: {x: *a19}\n" + tail + "*b19}}\n");

  EXPECT_EQ(key(maps, "nodes.arm.dcf").use, KeyUse::used);
  EXPECT_EQ(key(maps, "nodes.arm.x.k0").use, KeyUse::ignored);
  EXPECT_EQ(key(lists, "nodes.arm.dcf").use, KeyUse::used);
  EXPECT_EQ(key(lists, "nodes.arm.x").use, KeyUse::wrong);
}

TEST_F(Import, ALongListThatManyKeysNameTakesNoTime) {
  std::string list;
  for (int i = 0; i < 20'000; ++i) list += "{a: 1},";
  std::string keys;
  for (int i = 0; i < 20'000; ++i) keys += "k" + std::to_string(i) + ": *l,";

  const auto bus = report("arm: {node_id: 5, dcf: drive.eds}\n.l: &l [" + list + "]\n.k: {x: 1}\n" +
                          "leg: {node_id: 6, dcf: drive.eds, " + keys + "}\n");

  EXPECT_EQ(key(bus, "arm.dcf").use, KeyUse::used);
}

TEST_F(Import, TheSameNumberWrittenOtherwiseIsNoOtherValue) {
  const auto bus = report(
      "master: {sync_period: 10000}\n"
      "defaults: {dcf: drive.eds, boot_timeout_ms: 500}\n"
      "nodes:\n"
      "  arm: {node_id: 5, boot_timeout_ms: 0x1F4}\n"
      "  leg: {node_id: 6, boot_timeout_ms: 0x1F5}\n");

  EXPECT_EQ(key(bus, "nodes.arm.boot_timeout_ms").use, KeyUse::used);
  EXPECT_EQ(key(bus, "nodes.leg.boot_timeout_ms").use, KeyUse::suspicious);
}

TEST_F(Import, AKeyThatOnlyTheDriverClassCanKnowIsSuspiciousASlipIsWrong) {
  const auto bus = report(
      "master: {name: main, driver: x::Master, sync_period: 10000}\n"
      "arm: {node_id: 2, dcf: drive.eds, driver: x::Drive, gearbox_ratio: 20.0}\n"
      "leg: {node_id: 3, dcf: drive.eds, gearbox_ratio: 20.0}\n"
      "neck: {node_id: 4, dcf: drive.eds, driver: x::Drive, hartbeat_producer: 20}\n");

  EXPECT_EQ(key(bus, "master.name").use, KeyUse::suspicious);
  EXPECT_EQ(key(bus, "arm.gearbox_ratio").use, KeyUse::suspicious);
  EXPECT_THAT(key(bus, "arm.gearbox_ratio").why, HasSubstr("the class of `driver` may read it"));
  EXPECT_EQ(key(bus, "leg.gearbox_ratio").use, KeyUse::wrong);
  EXPECT_EQ(key(bus, "neck.hartbeat_producer").use, KeyUse::wrong);
}

TEST_F(Import, ReportsADeviceThatIsReportedAnotherSyncPeriod) {
  const auto bus = report(
      "master: {sync_period: 20000}\n"
      "arm: {node_id: 2, dcf: drive.eds, sdo: [{index: 0x1006, value: 10000}]}\n"
      "leg: {node_id: 3, dcf: drive.eds, sdo: [{index: 0x1006, value: 20000}]}\n"
      "neck: {node_id: 4, dcf: drive.eds, sdo: [{index: 0x1006, value: 0}]}\n");

  EXPECT_TRUE(bus.usable);
  EXPECT_EQ(key(bus, "arm.sdo[1]").use, KeyUse::suspicious);
  EXPECT_THAT(key(bus, "arm.sdo[1]").why, HasSubstr("10000 us, but the period is 20000 us"));
  EXPECT_EQ(key(bus, "leg.sdo[1]").use, KeyUse::used);
  EXPECT_EQ(key(bus, "neck.sdo[1]").use, KeyUse::used);
}

TEST_F(Import, WhatStandsInAnUnknownKeyIsNotUsed) {
  const auto bus = report(
      "arm: {node_id: 2, dcf: drive.eds, driver: x::Drive, motor_channels: {1: {node_id: 7}}}\n"
      "leg: {node_id: 3, dcf: drive.eds, motor_channels: {1: {node_id: 7}}}\n");

  EXPECT_EQ(key(bus, "arm.motor_channels").use, KeyUse::suspicious);
  EXPECT_EQ(key(bus, "arm.motor_channels.1.node_id").use, KeyUse::ignored);
  EXPECT_EQ(key(bus, "leg.motor_channels").use, KeyUse::wrong);
  EXPECT_EQ(key(bus, "leg.motor_channels.1.node_id").use, KeyUse::ignored);
}

TEST_F(Import, ReportsWhatIsDoneWithoutAWord) {
  const auto bus = report(
      "master: {node_id: 1, sync_period: 10000}\n"
      "arm: {node_id: 2, dcf: drive.eds, heartbeat_producer: 50}\n"
      "leg: {node_id: 3, dcf: drive.eds, heartbeat_consumer: false}\n"
      "neck: {node_id: 4, dcf: drive.eds, sdo: [{index: 0x60C2, sub_index: 1, value: 10}]}\n");

  EXPECT_THAT(bus.unasked,
              testing::ElementsAre(
                  "the master: heartbeat every 100 ms; `heartbeat_producer: 0` switches it off",
                  "1016:01 of `arm`, `neck`: the device watches the master (node 1) for 300 ms; "
                  "`heartbeat_consumer: false` switches it off",
                  "60C2:01 of `arm`, `leg`: interpolation period = SYNC period; an entry in `sdo` "
                  "sets another value",
                  "1017:00 of `leg`, `neck`: heartbeat every 100 ms; `heartbeat_producer: 0` "
                  "switches it off"));
}

TEST_F(Import, ATaktFileThatSaysAllHasNothingUnasked) {
  const auto bus = report(
      "master: {sync_period: 10000, heartbeat_producer: 100}\n"
      "defaults: {dcf: drive.eds, heartbeat_producer: 50, heartbeat_consumer: true, profile: "
      "none}\n"
      "nodes: {arm: {node_id: 2}}\n");

  EXPECT_THAT(bus.unasked, testing::IsEmpty());
}

TEST_F(Import, ReportsWhereDefaultsWouldHaveWon) {
  const auto bus = report(
      "master: {sync_period: 10000}\n"
      "defaults:\n"
      "  dcf: drive.eds\n"
      "  heartbeat_producer: 1000\n"
      "  boot_timeout_ms: 500\n"
      "nodes:\n"
      "  arm: {node_id: 2, heartbeat_producer: 200, boot_timeout_ms: 500}\n"
      "  leg: {node_id: 3}\n");

  EXPECT_TRUE(bus.usable);
  EXPECT_EQ(key(bus, "nodes.arm.heartbeat_producer").use, KeyUse::suspicious);
  EXPECT_THAT(key(bus, "nodes.arm.heartbeat_producer").why, HasSubstr("`1000`"));
  EXPECT_EQ(key(bus, "nodes.arm.boot_timeout_ms").use, KeyUse::used);
}

TEST_F(Import, AnIndexWithout0xIsReportedWithTheObjectThatWasMeant) {
  const auto bus = report(
      "arm: {node_id: 2, dcf: drive.eds, sdo: [{index: 6083, value: 1}], tpdo: {1: {mapping: "
      "[{index: 6041}]}}}\n");

  EXPECT_THAT(key(bus, "arm.sdo[1]").why,
              HasSubstr("6083 is 0x17C3: did you mean 0x6083 Profile acceleration?"));
  EXPECT_THAT(key(bus, "arm.tpdo.1.mapping[1]").why, HasSubstr("did you mean 0x6041 Statusword?"));
}

TEST_F(Import, AnEntryThatIsNoMapLeavesTheOthersTheirLines) {
  const auto bus =
      report("arm: {node_id: 2, dcf: drive.eds, sdo: [{index: 0x6083, value: 1}, [0x6084, 2]]}\n");

  EXPECT_EQ(key(bus, "arm.sdo[1]").use, KeyUse::used);
  EXPECT_EQ(key(bus, "arm.sdo[2]").use, KeyUse::wrong);
}

TEST_F(Import, ScalesOfADriverNameTheUnitsThatTakeTheirPlace) {
  const auto bus = report(
      "arm: {node_id: 2, dcf: drive.eds, scale_pos_from_dev: 0.1, scale_vel_from_dev: 0.1, "
      "scale_eff_from_dev: 0.1}\n");

  EXPECT_THAT(key(bus, "arm.scale_pos_from_dev").why, HasSubstr("units: {position:"));
  EXPECT_THAT(key(bus, "arm.scale_vel_from_dev").why, HasSubstr("units: {velocity:"));
  EXPECT_THAT(key(bus, "arm.scale_eff_from_dev").why, HasSubstr("units: {torque:"));
}

TEST_F(Import, AMapWhereAWordBelongsIsWrongAsAWhole) {
  const auto bus = report(
      "master:\n"
      "  heartbeat_consumer:\n"
      "    arm: 250\n"
      "    leg: 250\n"
      "arm: {node_id: 2, dcf: drive.eds}\n");

  EXPECT_EQ(key(bus, "master.heartbeat_consumer").use, KeyUse::wrong);
  EXPECT_EQ(key(bus, "master.heartbeat_consumer.arm").use, KeyUse::ignored);
  EXPECT_EQ(key(bus, "master.heartbeat_consumer.leg").use, KeyUse::ignored);
}

TEST_F(Import, NamesEveryKeyAsUsedOrIgnored) {
  const auto bus = report(
      "options: {dcf_path: \"@BUS_CONFIG_PATH@\"}\n"
      "master: {node_id: 1, driver: x, sync_period: 10000}\n"
      "defaults: {dcf: drive.eds, period: 10, diagnostics: {enable: true, period: 5}}\n"
      "nodes:\n"
      "  arm:\n"
      "    node_id: 2\n"
      "    tpdo: {1: {cob_id: auto, transmission: 1, mapping: [{index: 0x6041}, {index: "
      "0x6064}]}}\n"
      "    sdo: [{index: 0x6081, sub_index: 0, value: 1000}, {index: 0x6060, value: 1}]\n");

  EXPECT_TRUE(bus.usable);
  EXPECT_EQ(key(bus, "options.dcf_path").use, KeyUse::ignored);
  EXPECT_EQ(key(bus, "master.driver").use, KeyUse::ignored);
  EXPECT_EQ(key(bus, "master.sync_period").use, KeyUse::used);
  EXPECT_THAT(key(bus, "master.sync_period").why, HasSubstr("The period of SYNC"));
  EXPECT_EQ(key(bus, "master.sync_period").pos, (SourcePos{2, 33}));
  EXPECT_EQ(key(bus, "defaults.period").use, KeyUse::ignored);
  EXPECT_THAT(key(bus, "defaults.period").why, HasSubstr("the cycle is `sync_period`"));
  EXPECT_EQ(key(bus, "defaults.diagnostics.enable").use, KeyUse::ignored);
  EXPECT_EQ(key(bus, "nodes.arm.tpdo.1.cob_id").value, "auto");
  EXPECT_EQ(key(bus, "nodes.arm.tpdo.1.mapping[2]").value, "{index: 0x6064}");
  EXPECT_EQ(key(bus, "nodes.arm.sdo[1]").use, KeyUse::used);
  EXPECT_EQ(bus.count(KeyUse::suspicious) + bus.count(KeyUse::wrong), 0u);
}

TEST_F(Import, ReportsAnInterpolationPeriodThatIsNotTheCycle) {
  const auto bus = report(
      "master: {sync_period: 10000}\n"
      "arm:\n"
      "  node_id: 2\n"
      "  dcf: drive.eds\n"
      "  sdo:\n"
      "    - {index: 0x60C2, sub_index: 1, value: 50}\n"
      "    - {index: 0x60C2, sub_index: 2, value: -3}\n");

  EXPECT_TRUE(bus.usable);
  EXPECT_EQ(key(bus, "arm.sdo[1]").use, KeyUse::suspicious);
  EXPECT_THAT(key(bus, "arm.sdo[1]").why, HasSubstr("sets 50000 us, but the SYNC period is 10000"));
  EXPECT_EQ(key(bus, "arm.sdo[2]").use, KeyUse::used);
}

TEST_F(Import, PutsAnErrorToItsKey) {
  const auto bus = report(
      "master: {node_id: 1, baudrate: 1000000, sync_period: 10000}\n"
      "arm: {node_id: 2, dcf: drive.eds, sync_perod: 5,\n"
      "      tpdo: {1: {mapping: [{index: 0x6041}, {index: 0x6099}]}}}\n");

  EXPECT_FALSE(bus.usable);
  EXPECT_EQ(key(bus, "master.baudrate").use, KeyUse::suspicious);
  EXPECT_THAT(key(bus, "master.baudrate").why, HasSubstr("write 1000"));
  EXPECT_EQ(key(bus, "arm.sync_perod").use, KeyUse::wrong);
  EXPECT_EQ(key(bus, "arm.tpdo.1.mapping[1]").use, KeyUse::used);
  EXPECT_EQ(key(bus, "arm.tpdo.1.mapping[2]").use, KeyUse::wrong);
}

TEST_F(Import, Bit30OfATpdoStaysAsTheDeviceHasIt) {
  const auto bus = report(
      "master: {sync_period: 10000}\n"
      "arm: {node_id: 2, dcf: drive.eds, tpdo: {1: {transmission: 1, cob_id: 0x40000182}}}\n");

  EXPECT_TRUE(bus.usable);
  EXPECT_EQ(key(bus, "arm.tpdo.1.cob_id").use, KeyUse::suspicious);
  EXPECT_THAT(key(bus, "arm.tpdo.1.cob_id").why, HasSubstr("takt leaves this bit"));
}

TEST_F(Import, WhyAMasterNeedsNoEmcyInhibitTime) {
  const auto bus = report(
      "master: {sync_period: 10000, emcy_inhibit_time: 100, error_behavior: {1: 0}}\n"
      "arm: {node_id: 2, dcf: drive.eds, emcy_inhibit_time: 100, error_behavior: {1: 0}}\n");

  EXPECT_EQ(key(bus, "master.emcy_inhibit_time").use, KeyUse::ignored);
  EXPECT_THAT(key(bus, "master.emcy_inhibit_time").why, HasSubstr("sends no EMCY"));
  EXPECT_EQ(key(bus, "master.error_behavior.1").use, KeyUse::ignored);
  EXPECT_THAT(key(bus, "master.error_behavior.1").why, HasSubstr("has no 0x1029"));
  EXPECT_EQ(key(bus, "arm.emcy_inhibit_time").use, KeyUse::used);
  EXPECT_EQ(key(bus, "arm.error_behavior.1").use, KeyUse::used);
  EXPECT_THAT(key(bus, "arm.error_behavior.1").why, HasSubstr("1029"));
}

TEST_F(Import, AnAliasIsReportedOnce) {
  const auto bus = report(
      "master: {sync_period: 10000}\n"
      ".axis: &axis {dcf: drive.eds, driver: x}\n"
      "nodes: {a: {<<: *axis, node_id: 1}, b: {<<: *axis, node_id: 2}}\n");

  EXPECT_TRUE(bus.usable);
  EXPECT_EQ(bus.count(KeyUse::ignored), 1u);
  EXPECT_EQ(std::ranges::count(bus.keys, "x", &ImportedKey::value), 1);
}

TEST_F(Import, WhatBelongsToNoKeyIsAFinding) {
  const auto bus = report("[]\n");

  EXPECT_FALSE(bus.usable);
  EXPECT_EQ(bus.keys.size(), 0u);
  EXPECT_FALSE(bus.others.empty());
  EXPECT_FALSE(import_report("/nonexistent/bus.yml").usable);
  EXPECT_FALSE(report("a: [\n").usable);
}

TEST_F(Import, BusFilesOfTheWildAreReportedWhole) {
  const char* folder = std::getenv("TAKT_BUS_YML");
  const fs::path root =
      folder != nullptr ? fs::path{folder} : fs::path{TAKT_SOURCE_DIR} / "../shared/bus_yml";
  std::error_code error;
  for (const auto& entry : fs::directory_iterator{root, error}) {
    if (!fs::exists(entry.path() / "bus.yml")) continue;
    const auto bus = import_report(entry.path() / "bus.yml");
    EXPECT_GT(bus.count(KeyUse::used), 3u) << entry.path();
    for (const ImportedKey& one : bus.keys) {
      const bool reported = one.use == KeyUse::used || !one.why.empty();
      EXPECT_TRUE(reported) << entry.path() << one.path;
    }
    const bool has_its_eds = entry.path().filename() != "cia402_multichannel_system";
    EXPECT_EQ(bus.usable, has_its_eds) << entry.path();
  }
}

}  // namespace
}  // namespace takt
