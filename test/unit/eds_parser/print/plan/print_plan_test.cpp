#include "eds_parser/print/plan/print_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "eds_parser/network_file/load_network.hpp"
#include "eds_parser/print/plan/plan_names.hpp"

namespace takt {
namespace {

using testing::HasSubstr;
using testing::Not;

const BusPlan& demo() {
  static const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");
  return network.plan;
}
std::string text_of(const PlanPrint& what) {
  std::ostringstream out;
  print_plan_text(out, demo(), what);
  return out.str();
}
nlohmann::json json_of(const PlanPrint& what) {
  std::ostringstream out;
  print_plan_json(out, demo(), what);
  return nlohmann::json::parse(out.str());
}

TEST(PlanText, ShowsTheUnitsAndTheFallbackOfAValue) {
  const std::string text = text_of({});

  EXPECT_THAT(text, HasSubstr("elbow.position_actual_value"));
  EXPECT_THAT(text, HasSubstr("  x 0.000628319 rad\n"));
  EXPECT_THAT(text,
              HasSubstr("  x 0.000628319 rad  first position_actual_value; after 500 cycles "));
  EXPECT_THAT(text, HasSubstr("; after 500 cycles 0x"));
}

std::vector<std::string> brief_of(const BusPlan& plan, const Findings& findings) {
  std::ostringstream out;
  print_plan_brief(out, plan, findings);
  std::vector<std::string> lines;
  std::istringstream text{out.str()};
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

TEST(PlanBrief, IsOneScreenOfWhatMatters) {
  const std::vector<std::string> lines = brief_of(demo(), {});

  ASSERT_LE(lines.size(), 24U);
  std::string text;
  for (const std::string& line : lines) {
    EXPECT_LE(line.size(), 80U) << line;
    text += line + '\n';
  }
  EXPECT_THAT(text, HasSubstr("bus demo: 3 nodes, 2 axes at 1000 kbit/s, simulated\n"));
  EXPECT_THAT(text, HasSubstr("SYNC every 2000 us: TPDOs until 1020, outputs at 1295 us; PDO load "
                              "57 %\n"));
  EXPECT_THAT(text,
              HasSubstr("shoulder  axis, mandatory        2 TPDO  2 RPDO  lost after 300 ms"));
  EXPECT_THAT(text, HasSubstr("shoulder: file: position -100 .. 100 rad, velocity 40 rad/s"));
  EXPECT_THAT(text, HasSubstr("findings: 0 errors, 0 warnings, 0 notes"));
}

TEST(PlanBrief, OfALargeBusWithManyFindingsIsOneScreenToo) {
  BusPlan plan = demo();
  const NodePlan node = plan.nodes.front();
  for (std::uint8_t id = 20; id < 120; ++id) {
    plan.nodes.push_back(node);
    plan.nodes.back().id = *NodeId::from(id);
    plan.nodes.back().name = "a node with a very long name, number " + std::to_string(id);
  }
  Findings findings;
  for (int i = 0; i < 50; ++i) {
    findings.push_back({.file = "/a/folder/net.yaml",
                        .pos = {},
                        .severity = i == 49 ? Severity::warning : Severity::note,
                        .rule = "rule",
                        .message = std::string(200, 'x') + " and more"});
  }
  const std::vector<std::string> lines = brief_of(plan, findings);

  EXPECT_LE(lines.size(), 24U);
  for (const std::string& line : lines) EXPECT_LE(line.size(), 80U) << line;
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  EXPECT_THAT(text, HasSubstr("findings: 0 errors, 1 warning, 49 notes\n  warning: net.yaml:"));
  EXPECT_THAT(text, HasSubstr(" lines more\n"));
}

TEST(PlanText, IndentsTheStepsThatABootMaySkip) {
  BusPlan plan = demo();
  auto& steps = plan.nodes[0].boot_plan.steps;
  steps.resize(3);
  steps[0] = {.action = BootAction::skip_if_same, .target = 2};
  steps[1] = {.action = BootAction::write};
  steps[2] = {.action = BootAction::write};
  std::ostringstream out;
  print_plan_text(out, plan, {});

  EXPECT_THAT(out.str(), testing::ContainsRegex("\n +1 +skip if same +-> 3\n"));
  EXPECT_THAT(out.str(), testing::ContainsRegex("\n +2 .   write "));
  EXPECT_THAT(out.str(), testing::ContainsRegex("\n +3 . write "));
}

TEST(PlanText, WritesAValueAsANumberOrAsBytes) {
  const auto value = [](std::size_t bytes) {
    BootStep step;
    for (std::size_t i = 0; i < bytes; ++i) step.value.push_back(static_cast<std::byte>(i + 1));
    return value_text(step);
  };

  EXPECT_EQ(value(0), "");
  EXPECT_EQ(value(2), "0x0201");
  EXPECT_EQ(value(8), "0x0807060504030201");
  EXPECT_EQ(value(9), "010203040506070809");
  EXPECT_EQ(value(65), "65 bytes");
}

TEST(PlanText, NamesEachNmtCommand) {
  EXPECT_EQ(command_name(NmtCommand::start), "start");
  EXPECT_EQ(command_name(NmtCommand::stop), "stop");
  EXPECT_EQ(command_name(NmtCommand::enter_preoperational), "enter pre-operational");
  EXPECT_EQ(command_name(NmtCommand::reset_node), "reset node");
  EXPECT_EQ(command_name(NmtCommand::reset_communication), "reset communication");
}

TEST(PlanText, ListsTypedMessagesOnlyIfTheyArePublished) {
  EXPECT_THAT(text_of({}), HasSubstr("inputs of this node, in SI if it has units"));
  PlanPrint untyped;
  untyped.lcm.typed = false;
  EXPECT_THAT(text_of(untyped), Not(HasSubstr("inputs of this node")));
}

TEST(PlanJson, HasTheIdentityThatTheBootExpects) {
  BusPlan plan = demo();
  plan.nodes[0].boot_plan.steps = {
      {.action = BootAction::expect, .object = {0x1000, 0}, .value = {std::byte{7}}},
      {.action = BootAction::expect, .object = {0x1018, 1}, .value = {std::byte{1}, std::byte{2}}},
      {.action = BootAction::expect, .object = {0x1018, 2}, .value = {std::byte{3}}},
      {.action = BootAction::expect, .object = {0x1018, 3}, .value = {std::byte{4}}},
      {.action = BootAction::expect, .object = {0x1018, 4}, .value = {std::byte{5}}}};
  std::ostringstream out;
  print_plan_json(out, plan, {});
  const auto json = nlohmann::json::parse(out.str());

  EXPECT_EQ(json["nodes"][0]["identity"].dump(),
            R"({"device_type":7,"product_code":3,"revision_number":4,"serial_number":5,)"
            R"("vendor_id":513})");
}

TEST(PlanJson, HasTheLimitsOfTheNodeThatIsAskedFor) {
  PlanPrint of_one;
  of_one.node = demo().nodes[0].id;
  const auto every = json_of({});
  const auto one = json_of(of_one);

  EXPECT_EQ(every["limits"].size(), demo().limits.lines.size());
  EXPECT_FALSE(one["limits"].empty());
  EXPECT_LT(one["limits"].size(), every["limits"].size());
  EXPECT_EQ(one["nodes"].size(), 1U);
}

}  // namespace
}  // namespace takt
