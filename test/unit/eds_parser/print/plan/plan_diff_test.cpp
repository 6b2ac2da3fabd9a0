#include "eds_parser/print/plan/plan_diff.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <unistd.h>

#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/print/plan/plan_diff_json.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class PlanDiff : public testing::Test {
 protected:
  const test::Folder folder_;

  LoadedNetwork load(const std::string& text) {
    LoadedNetwork network = load_network(folder_.write("net.yaml", text));
    for (const Finding& finding : network.findings) {
      if (finding.severity == Severity::error) ADD_FAILURE() << to_string(finding);
    }
    return network;
  }
  std::string diff(const std::string& before, const std::string& after) {
    const LoadedNetwork first = load(before);
    const LoadedNetwork second = load(after);
    return plan_diff({first.plan, "old"}, {second.plan, "new"});
  }
};

const std::string drive = "dcf: " TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds";
const std::string base = "master: {sync_period: 10000}\narm: {node_id: 5, " + drive +
                         ", tpdo: {1: {transmission: 1, cob_id: 0x185}}}\n";

TEST_F(PlanDiff, EqualPlansHaveNoDifference) { EXPECT_EQ(diff(base, base), ""); }

TEST_F(PlanDiff, ANodeMoreChangesNoLineOfTheOthers) {
  const std::string text =
      diff(base, base + "a_node_with_a_long_name: {node_id: 6, " + drive + "}\n");

  EXPECT_THAT(text, HasSubstr("+  in  a_node_with_a_long_name.statusword  6041:00 UNSIGNED16\n"));
  EXPECT_THAT(text, Not(HasSubstr("-  in  arm.")));
  EXPECT_THAT(
      text,
      Not(HasSubstr("takt.layout_t  at start and once a second: the meaning of the values\n+")));
  EXPECT_THAT(text, Not(HasSubstr("-  NET_")));
}

TEST_F(PlanDiff, AnotherPathToTheSameDeviceFileIsNoDifference) {
  std::string other = base;
  other.replace(other.find("/share/eds/"), 11, "/share/demo/../eds/");

  EXPECT_EQ(diff(base, other), "");
}

TEST_F(PlanDiff, ShowsACobIdInThePdoTableAndInTheBoot) {
  std::string other = base;
  other.replace(other.find("0x185"), 5, "0x1A5");

  const std::string text = diff(base, other);

  EXPECT_THAT(text, HasSubstr("--- old\n+++ new\n@@ -"));
  EXPECT_THAT(text, HasSubstr("-  TPDO1 0x185  6 bytes  every SYNC\n"
                              "+  TPDO1 0x1A5  6 bytes  every SYNC\n"));
  EXPECT_THAT(text, HasSubstr("@@ boot of node 5 arm: "));
  EXPECT_THAT(text, HasSubstr("TPDO1 COB-ID 0x1A5\n"));
  EXPECT_THAT(text, Not(HasSubstr("\n-bus")));
}

TEST_F(PlanDiff, SaysTheSameInJsonByPartAndNode) {
  std::string other = base;
  other.replace(other.find("0x185"), 5, "0x1A5");
  const LoadedNetwork first = load(base);
  const LoadedNetwork second = load(other);
  std::ostringstream same;
  std::ostringstream out;

  print_plan_diff_json(same, {first.plan, "old"}, {first.plan, "old"});
  print_plan_diff_json(out, {first.plan, "old"}, {second.plan, "new"});

  EXPECT_EQ(nlohmann::json::parse(same.str()).at("changes").size(), 0U);
  const auto json = nlohmann::json::parse(out.str());
  EXPECT_EQ(json.at("before"), "old");
  EXPECT_EQ(json.at("after"), "new");
  const auto& change = json.at("changes").at(0);
  EXPECT_EQ(change.at("part"), "node");
  EXPECT_EQ(change.at("node"), 5);
  EXPECT_EQ(change.at("name"), "arm");
  EXPECT_EQ(change.at("removed").at(0), "TPDO1 0x185  6 bytes  every SYNC");
  EXPECT_EQ(change.at("added").at(0), "TPDO1 0x1A5  6 bytes  every SYNC");
  EXPECT_EQ(json.at("changes").back().at("part"), "boot");
}

TEST_F(PlanDiff, AnSdoStepMoreIsOneLineMore) {
  std::string other = base;
  other.insert(other.find(", tpdo"), ", sdo: [{index: 0x6083, value: 7}]");

  const std::string text = diff(base, other);

  EXPECT_THAT(text, HasSubstr("+  J write if differs   605#4083600000000000  0x00000007"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '+'), 3 + 3 + 1) << text;  // head, hunks, lines
}

TEST_F(PlanDiff, ANodeThatIsGoneIsRemovedWhole) {
  const std::string more = base + "leg: {node_id: 9, " + drive + "}\n";

  const std::string text = diff(more, base);

  EXPECT_THAT(text, HasSubstr("-node 9 leg: takt drive 402"));
  EXPECT_THAT(text, HasSubstr("-boot of node 9 leg: "));
  EXPECT_THAT(text, HasSubstr("-  in  leg.statusword"));
}

TEST_F(PlanDiff, TheCycleAndTheImageAreCompared) {
  std::string slower = base;
  slower.replace(slower.find("10000"), 5, "20000");

  EXPECT_THAT(diff(base, slower), HasSubstr("-cycle: 10000 us"));
  EXPECT_THAT(diff(base, slower), HasSubstr("+cycle: 20000 us"));
}

TEST_F(PlanDiff, ShowsWhatADeviceDataEntryChanges) {
  const fs::path file = TAKT_SOURCE_DIR "/share/demo/lenze8400.yaml";
  const LoadedNetwork with = load_network(file);
  const LoadedNetwork without = load_network(file, DeviceDataUse::ignored);

  const std::string text =
      node_diff({without.plan, "without"}, {with.plan, "with"}, with.plan.nodes.at(0).id);

  EXPECT_THAT(text, HasSubstr("+  device data: Lenze 8400 (lenze8400.yaml)\n"));
  EXPECT_THAT(text, HasSubstr("+  J read firmware"));
  EXPECT_THAT(text, Not(HasSubstr("\n-  TPDO")));
}

const std::string limited =
    "master: {sync_period: 10000}\narm: {node_id: 5, " + drive +
    ", profile: cia402, units: {position: {scale: 0.001, unit: rad}}, "
    "rpdo: {1: {transmission: 1, mapping: [{index: 0x6040}, {index: 0x607A}]}}, limits: {";

TEST_F(PlanDiff, AnotherLimitIsADifference) {
  const std::string text = diff(limited + "position: [-1, 1], step: 0.1}}\n",
                                limited + "position: [-1, 100], step: 0.1}}\n");

  EXPECT_THAT(text, HasSubstr("-  arm  position  -1 .. 1 rad  from the network file\n"));
  EXPECT_THAT(text, HasSubstr("+  arm  position  -1 .. 100 rad  from the network file\n"));
  EXPECT_THAT(text, Not(HasSubstr("-  arm  step")));
}

TEST_F(PlanDiff, ALimitThatTheDeviceReportsFromNowOnIsADifference) {
  const LoadedNetwork before = load(limited + "position: [-1, 1], step: 0.1}}\n");
  const LoadedNetwork after = load(limited + "step: 0.1}}\n");
  const auto changes = plan_changes({before.plan, "old"}, {after.plan, "new"}, std::nullopt);

  const auto found = std::ranges::find(changes, "limits", &PlanChange::part);
  ASSERT_NE(found, changes.end());
  ASSERT_EQ(found->added.size(), 1U);
  EXPECT_THAT(found->added[0], HasSubstr("read from the device at boot, 607D:01"));
}

}  // namespace
}  // namespace takt
