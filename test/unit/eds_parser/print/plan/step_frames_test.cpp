#include "eds_parser/print/plan/step_frames.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

#include "eds_parser/print/plan/print_plan.hpp"
#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using test::compile;
using test::Compiled;
using testing::ElementsAre;

/// Returns a text for each step of the first node that has one of these actions: its first frame
/// and, after a blank, the download that may follow.
std::vector<std::string> frames(const Compiled& net, std::initializer_list<BootAction> kinds) {
  const NodePlan& node = net.plan.nodes.at(0);
  const std::vector<StepFrames> all = step_frames(node);
  std::vector<std::string> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::ranges::count(kinds, node.boot_plan.steps[i].action) == 0) continue;
    out.push_back(all[i].first + (all[i].write.empty() ? "" : " " + all[i].write));
  }
  return out;
}

TEST(StepFrames, AreThoseOfTheReference) {
  const auto net = compile(
      "arm: {node_id: 5, dcf: x, tpdo: {1: {transmission: 255, mapping: [{index: 0x6041}, "
      "{index: 0x6064}]}}, sdo: [{index: 0x2001, value: 6}]}\n");

  EXPECT_THAT(frames(net, {BootAction::write, BootAction::nmt}),
              ElementsAre("000#8205", "605#2B01200006000000", "605#2F00160000000000",
                          "605#2300160110004060", "605#2F00160001000000", "605#2F001A0000000000",
                          "605#23001A0110004160", "605#23001A0220006460", "605#2F001A0002000000",
                          "000#0105"));
}

TEST(StepFrames, GoOnTheSdoChannelOfTheNode) {
  const auto net = compile(
      "nodes: {arm: {node_id: 5, dcf: x, sdo_channel: {request: 0x645, answer: 0x5C5}, "
      "sdo: [{index: 0x2001, value: 6}]}}\n");

  EXPECT_THAT(frames(net, {BootAction::probe, BootAction::write}),
              testing::IsSupersetOf({"645#4000100000000000", "645#2B01200006000000"}));
}

TEST(StepFrames, ReadACobIdBeforeItIsSwitchedOffOnlyWhereItIsNotKnown) {
  const auto net = compile(
      "arm: {node_id: 5, dcf: x, rpdo: {1: {enabled: false}}, tpdo: {1: {transmission: 1, "
      "mapping: [{index: 0x6041}]}}}\n");

  EXPECT_THAT(frames(net, {BootAction::disable_pdo, BootAction::enable_pdo}),
              ElementsAre("605#23001401........",                       // compared just before
                          "605#4000180100000000 605#23001801........",  // the mapping comes first
                          "605#23001801........", "605#23001801850100.."));
}

TEST(StepFrames, HaveWhatIsWrittenWhereItDiffers) {
  const auto net = compile("arm: {node_id: 5, dcf: x, sdo: [{index: 0x6081, value: 7}]}\n");

  EXPECT_THAT(frames(net, {BootAction::write_if_differs}),
              testing::Contains("605#4081600000000000 605#2381600007000000"));
}

TEST(StepFrames, OfLongValuesGoByBlockWhereThatIsAllowed) {
  auto net = compile("arm: {node_id: 5, dcf: x}\n");
  NodePlan& node = net.plan.nodes[0];
  node.boot_plan.steps = {{.action = BootAction::write, .object = {0x1F50, 1}, .value{}}};
  const auto first_with = [&](std::size_t size) {
    node.boot_plan.steps[0].value.resize(size);
    return step_frames(node).at(0).first.substr(4);
  };

  EXPECT_EQ(first_with(127), "21501F017F000000");
  EXPECT_EQ(first_with(128), "C6501F0180000000");
  node.sdo.block = SdoBlockUse::off;
  EXPECT_EQ(first_with(128), "21501F0180000000");
}

TEST(PlanJson, SaysWhereANodeThatRunsGoesOn) {
  const auto net = compile("nodes: {arm: {node_id: 5, dcf: x, reset: keep_alive}}\n");

  std::ostringstream out;
  print_plan_json(out, net.plan, {.node = {}, .realtime = {}, .lcm = {}});
  const auto step = nlohmann::json::parse(out.str())["nodes"][0]["boot_plan"][0];

  EXPECT_EQ(step["action"], "await life");
  EXPECT_EQ(step["target"], net.plan.nodes[0].boot_plan.steps[0].target + 1);
}

}  // namespace
}  // namespace takt
