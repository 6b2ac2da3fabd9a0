// Other generators silently change some settings of a bus.yml; the import must not do this.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "eds_parser/network_file/load_network.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Trap : public testing::Test {
 protected:
  const test::Folder folder_;
  Trap() { fs::copy_file(TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds", folder_ / "drive.eds"); }

  LoadedNetwork load(const std::string& arm, const std::string& master = "sync_period: 10000") {
    std::ofstream{folder_ / "bus.yml"} << "master: {" + master +
                                              "}\narm: {node_id: 5, dcf: "
                                              "drive.eds" +
                                              (arm.empty() ? "" : ", " + arm) + "}\n";
    return load_network(folder_ / "bus.yml");
  }
  static std::string errors(const LoadedNetwork& network) {
    std::string text;
    for (const Finding& finding : network.findings) {
      if (finding.severity == Severity::error) text += finding.message + '\n';
    }
    return text;
  }
  /// Returns the boot steps with `action` on an object.
  static std::vector<BootStep> steps(const LoadedNetwork& network, ObjectKey object,
                                     BootAction action) {
    std::vector<BootStep> found;
    for (const BootStep& step : network.plan.nodes.at(0).boot_plan.steps) {
      if (step.object == object && step.action == action) found.push_back(step);
    }
    return found;
  }
  static std::int64_t value(const BootStep& step) {
    std::int64_t value = 0;
    for (std::size_t i = 0; i < step.value.size(); ++i) {
      value |= std::to_integer<std::int64_t>(step.value[i]) << (8 * i);
    }
    return value;
  }
};

TEST_F(Trap, AValueThatEqualsTheEdsDefaultIsComparedWithTheDeviceAllTheSame) {
  const auto network = load("tpdo: {1: {transmission: 1}, 4: {enabled: false}}");

  ASSERT_EQ(errors(network), "");
  EXPECT_EQ(steps(network, {0x1800, 2}, BootAction::compare).size(), 1u);
  EXPECT_EQ(steps(network, {0x1800, 3}, BootAction::compare).size(), 1u);
  EXPECT_EQ(steps(network, {0x1803, 1}, BootAction::compare).size(), 1u) << "off in the EDS too";
  EXPECT_EQ(steps(network, {0x1803, 1}, BootAction::disable_pdo).size(), 1u);
}

TEST_F(Trap, BitsOfACobIdAreNotLost) {
  const auto network = load("tpdo: {1: {transmission: 1, cob_id: 0x20012345}}");

  ASSERT_EQ(errors(network), "");
  EXPECT_EQ(network.plan.pdos.tpdos.at(0).cob_id, CobId::extended(0x12345));
  const auto on = steps(network, {0x1800, 1}, BootAction::enable_pdo);  // does not change bit 30
  ASSERT_EQ(on.size(), 1u);
  EXPECT_EQ(value(on[0]), 0x2001'2345);
}

TEST_F(Trap, AutomaticCobIdsLieBelowSdo) {
  std::string text = "nodes:\n";
  for (int node = 1; node <= 30; ++node) {
    text += "  n" + std::to_string(node) + ": {node_id: " + std::to_string(node) +
            ", dcf: drive.eds, tpdo: {4: {cob_id: auto, transmission: 1, mapping: [{index: "
            "0x6041}]}}, rpdo: {4: {cob_id: auto, transmission: 1, mapping: [{index: 0x6040}]}}}\n";
  }
  std::ofstream{folder_ / "many.yml"} << "master: {sync_period: 100000}\n" + text;

  const auto network = load_network(folder_ / "many.yml");

  ASSERT_EQ(errors(network), "");
  for (const auto* rows : {&network.plan.pdos.tpdos, &network.plan.pdos.rpdos}) {
    for (const PdoRow& row : *rows) EXPECT_LT(row.cob_id.id(), 0x580u);
  }
}

TEST_F(Trap, AnEventDeadlineNeedsNoEventTimer) {
  const auto network = load(
      "rpdo: {1: {transmission: 255, event_deadline: 70}}, "
      "tpdo: {1: {transmission: 255, event_deadline: 50}}");

  ASSERT_EQ(errors(network), "");
  const auto watched = steps(network, {0x1400, 5}, BootAction::write_if_differs);
  ASSERT_EQ(watched.size(), 1u);
  EXPECT_EQ(value(watched[0]), 70);
  EXPECT_EQ(network.plan.pdos.tpdos.at(0).deadline, std::chrono::milliseconds{50});
}

TEST_F(Trap, AnEventTimerBesideADeadlineIsNotMistakenForIt) {
  const auto network = load("tpdo: {1: {transmission: 255, event_timer: 20, event_deadline: 50}}");

  const auto timer = steps(network, {0x1800, 5}, BootAction::write_if_differs);
  ASSERT_EQ(timer.size(), 1u);
  EXPECT_EQ(value(timer[0]), 20);
  EXPECT_EQ(network.plan.pdos.tpdos.at(0).deadline, std::chrono::milliseconds{50});
}

TEST_F(Trap, AMappingThatCannotWorkIsAnError) {
  EXPECT_THAT(errors(load("tpdo: {1: {mapping: [{index: 0x1008}]}}")), HasSubstr("1008:00"));
  EXPECT_THAT(errors(load("tpdo: {1: {mapping: [{index: 0x6064}, {index: 0x606C}, "
                          "{index: 0x6041}]}}")),
              HasSubstr("a PDO holds 64"));
}

TEST_F(Trap, AnUnknownKeyIsAnErrorWithTheKeyThatWasMeant) {
  EXPECT_THAT(errors(load("hearbeat_producer: 100")),
              HasSubstr("did you mean `heartbeat_producer`"));
}

TEST_F(Trap, AValueInTheWrongUnitIsRefused) {
  EXPECT_THAT(errors(load("", "sync_period: 10")), HasSubstr("for 10 ms write 10000"));
  EXPECT_THAT(errors(load("", "baudrate: 512000")), HasSubstr("CAN allows at most 1000 kbit/s"));
}

// As in the tutorial of Lely: SYNC comes every second, and the outputs have to be safe before the
// end.
TEST_F(Trap, AnOrderedStopHasTheTimeThatASlowCycleNeeds) {
  EXPECT_GE(load("", "sync_period: 1000000").plan.stop_timeout, std::chrono::seconds{10});
  EXPECT_EQ(load("", "sync_period: 10000").plan.stop_timeout, std::chrono::seconds{5});
  EXPECT_EQ(load("", "sync_period: 1000000, stop_timeout: 3000").plan.stop_timeout,
            std::chrono::seconds{3});
}

TEST_F(Trap, AQuotedFalseIsFalseAndReported) {
  const auto network = load("tpdo: {1: {enabled: \"false\"}}");

  ASSERT_EQ(errors(network), "");
  EXPECT_TRUE(std::ranges::any_of(network.findings, [](const Finding& finding) {
    return finding.rule == "quoted" && finding.severity == Severity::warning;
  }));
  EXPECT_EQ(steps(network, {0x1800, 1}, BootAction::disable_pdo).size(), 1u);
  EXPECT_EQ(steps(network, {0x1800, 1}, BootAction::enable_pdo).size(), 0u);
}

TEST_F(Trap, ANodeThatRunsIsNotResetWhereTheFileSaysSo) {
  const auto network = load("reset_communication: false");

  ASSERT_EQ(errors(network), "");
  EXPECT_EQ(network.plan.nodes.at(0).boot_plan.steps.at(0).action, BootAction::await_alive);
}

TEST_F(Trap, TheSlaveKeyTimeCobIdIsRead) {
  const auto network = load("time_cob_id: 0x80000100");

  const bool can = steps(network, {0x1012, 0}, BootAction::write_if_differs).size() +
                       steps(network, {0x1012, 0}, BootAction::compare).size() >
                   0;
  EXPECT_TRUE(can || errors(network).find("1012:00") != std::string::npos) << errors(network);
}

TEST_F(Trap, TwoNodesOfOneIdAndOneCobIdTwiceAreErrors) {
  std::ofstream{folder_ / "two.yml"}
      << "master: {sync_period: 10000}\n"
         "a: {node_id: 5, dcf: drive.eds, tpdo: {1: {cob_id: 0x190, transmission: 1}}}\n"
         "b: {node_id: 6, dcf: drive.eds, tpdo: {1: {cob_id: 0x190, transmission: 1}}}\n"
         "c: {node_id: 6, dcf: drive.eds}\n";

  const std::string reported = errors(load_network(folder_ / "two.yml"));

  EXPECT_THAT(reported, HasSubstr("0x190"));
  EXPECT_THAT(reported, HasSubstr("node id 6"));
}

TEST_F(Trap, AnObjectWrittenTwiceIsReportedAndWrittenTwiceInThisOrder) {
  const auto network = load("sdo: [{index: 0x6040, value: 0x80}, {index: 0x6040, value: 6}]");

  EXPECT_EQ(errors(network), "");
  const auto writes = steps(network, {0x6040, 0}, BootAction::write_if_differs);
  ASSERT_EQ(writes.size(), 2u);
  EXPECT_EQ(value(writes[0]), 0x80);
  EXPECT_EQ(value(writes[1]), 6);
}

TEST_F(Trap, ASafeValueTwiceIsAnError) {
  EXPECT_THAT(errors(load("safe_values: [{index: 0x6040, value: 1}, {index: 0x6040, value: 2}]")),
              HasSubstr("6040:00 of node `arm` is written twice"));
}

}  // namespace
}  // namespace takt
