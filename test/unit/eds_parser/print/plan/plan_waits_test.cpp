#include "eds_parser/print/plan/plan_waits.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

#include "eds_parser/print/plan/print_plan.hpp"
#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::compile;
using testing::Contains;
using testing::ElementsAre;
using testing::Pair;

using Limits = std::vector<std::pair<std::string, Time>>;

std::vector<PlanWait> named(const BusPlan& plan, const std::string& wait) {
  std::vector<PlanWait> found = plan_waits(plan);
  std::erase_if(found, [&](const PlanWait& one) { return one.wait != wait; });
  return found;
}
Limits limits(const BusPlan& plan) {
  Limits out;
  for (const PlanWait& wait : plan_waits(plan)) out.emplace_back(wait.wait, wait.limit);
  return out;
}

TEST(PlanWaits, HoldEveryWaitThatNobodyHasConfigured) {
  const auto net = compile("master: {sync_period: 10000}\nnodes: {arm: {node_id: 5, dcf: x}}\n");

  EXPECT_THAT(
      limits(net.plan),
      ElementsAre(Pair("sdo_answer", 500ms), Pair("sdo_object", 5s), Pair("sdo_probe", 500ms),
                  Pair("sdo_settle", 20ms), Pair("sdo_sub_block", 40ms), Pair("sdo_server", 1s),
                  Pair("pdo_answer", 500ms), Pair("pdo_turn", 8s), Pair("lss_answer", 1s),
                  Pair("lss_store", 5s), Pair("lss_all", 100ms), Pair("held_sync", 30s),
                  Pair("transfer_silence", 10s), Pair("stop_fallback", 500ms),
                  Pair("stop_quick_stop", 4s), Pair("stop_disable", 4350ms),
                  Pair("stop_disarm", 4700ms), Pair("stop_nmt", 4980ms)));
}

TEST(PlanWaits, NameTheNodesWhereTheyDiffer) {
  const auto net = compile(
      "nodes:\n"
      "  arm: {node_id: 5, dcf: x, sdo_timeout_ms: 50}\n"
      "  leg: {node_id: 6, dcf: x}\n"
      "  toe: {node_id: 7, dcf: x, sdo_timeout_ms: 50}\n");
  const auto waits = named(net.plan, "sdo_answer");

  ASSERT_EQ(waits.size(), 2U);
  EXPECT_EQ(waits[0].limit, 50ms);
  EXPECT_TRUE(waits[0].what.starts_with("SDO answer of arm, toe;")) << waits[0].what;
  EXPECT_TRUE(waits[0].what.ends_with(" after 35 ms")) << waits[0].what;
  EXPECT_EQ(waits[1].limit, 500ms);
  EXPECT_TRUE(waits[1].what.starts_with("SDO answer of leg;")) << waits[1].what;
}

TEST(PlanWaits, ReportTheTimeOutsOfObjectsAndNotThoseThatNeverCount) {
  const auto net = compile(
      "nodes:\n"
      "  arm: {node_id: 5, dcf: x}\n"
      "  leg: {node_id: 6, dcf: x, sdo_timeouts: [{index: 0x1010, timeout_ms: 9000},\n"
      "                                          {index: 0x1F50, sub_index: 1, timeout_ms: "
      "5000}]}\n");
  std::vector<std::pair<Time, std::string>> reported;
  for (const PlanWait& wait : named(net.plan, "sdo_object"))
    reported.emplace_back(wait.limit, wait.what);

  EXPECT_THAT(reported, ElementsAre(Pair(Time{5s}, "SDO answer of arm for 1010"),
                                    Pair(Time{5s}, "SDO answer of every node for 1011"),
                                    Pair(Time{5s}, "SDO answer of leg for 1F50:01"),
                                    Pair(Time{9s}, "SDO answer of leg for 1010")));
}

TEST(PlanWaits, OfASyncThatAnotherDeviceMakesAreOthers) {
  const auto quick = compile(
      "master: {sync_source: external, sync_period: 10000}\n"
      "nodes: {arm: {node_id: 5, dcf: x}}\n");
  EXPECT_TRUE(named(quick.plan, "held_sync").empty());
  ASSERT_EQ(named(quick.plan, "first_sync").size(), 1U);
  EXPECT_EQ(named(quick.plan, "first_sync")[0].limit, 1s);

  BusPlan slow = quick.plan;
  slow.cycle.sync_timeout = 4s;
  EXPECT_EQ(named(slow, "first_sync")[0].limit, 4s);
}

TEST(PlanWaits, OfLssSearchesAreThereWhereANodeGetsItsIdSo) {
  const auto net = compile("nodes: {arm: {node_id: 5, dcf: x, lss: true}}\n");
  EXPECT_THAT(limits(net.plan), Contains(Pair("lss_look_again", Time{1s})));
  EXPECT_THAT(limits(net.plan), Contains(Pair("lss_let_boot", Time{5s})));
}

TEST(PlanWaits, StandInTheJsonAsInTheText) {
  const auto net = compile("nodes: {arm: {node_id: 5, dcf: x}}\n");
  std::ostringstream json;
  std::ostringstream text;
  print_plan_json(json, net.plan, {});
  print_plan_text(text, net.plan, {});
  const auto waits = nlohmann::json::parse(json.str()).at("waits");

  ASSERT_EQ(waits.size(), plan_waits(net.plan).size());
  for (const auto& wait : waits) {
    const auto ms = static_cast<long>(wait.at("limit_us").get<double>() / 1000);
    const std::string line =
        std::to_string(ms) + " ms  " + wait.at("what").get<std::string>() + "\n";
    EXPECT_NE(text.str().find(line), std::string::npos) << line;
  }
}

TEST(PlanWaits, PrintTheStagesOfTheStopInMilliseconds) {
  auto net = compile("master: {sync_period: 10000}\nnodes: {arm: {node_id: 5, dcf: x}}\n");
  net.plan.stop_timeout = 7421875us;
  std::ostringstream out;
  print_plan_text(out, net.plan, {});
  const std::string text = out.str();
  EXPECT_NE(text.find("742.2 ms  ordered stop: outputs take their fallback"), std::string::npos);
  EXPECT_NE(text.find("5937.5 ms  ordered stop: axes stop by quick stop"), std::string::npos);
  EXPECT_NE(text.find("ordered stop within 7421.9 ms"), std::string::npos);
}

}  // namespace
}  // namespace takt
