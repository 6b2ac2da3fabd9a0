#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::compile;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Makes the usual objects and an SDO server with these COB-IDs.
std::string eds_with_server(const std::string& request, const std::string& answer) {
  return test::tiny_objects() + test::record("1201", "SDO server 2", 3) +
         test::entry("1201sub0", "highest", 5, "const", "2") +
         test::entry("1201sub1", "client to server", 7, "rw", request) +
         test::entry("1201sub2", "server to client", 7, "rw", answer);
}

std::string on_channel(const std::string& channel) {
  return "master: {sync_period: 10000}\nnodes:\n  arm:\n    node_id: 5\n    dcf: x\n    "
         "sdo_channel: " +
         channel + "\n";
}
const std::string on_second = on_channel("{request: 0x645, answer: 0x5C5}");

TEST(SdoAccess, IsTheDefaultChannelWithBlockWhereNobodySaysOtherwise) {
  const auto net = compile("nodes: {arm: {node_id: 5, dcf: x}}\n");
  const NodePlan& node = net.plan.nodes.at(0);
  EXPECT_EQ(node.sdo.channel_of(node.id), (SdoChannel{CobId::base(0x605), CobId::base(0x585)}));
  EXPECT_EQ(node.sdo.block, SdoBlockUse::automatic);
  EXPECT_EQ(node.sdo.timeout_of({0x6041, 0}, 500ms), 500ms);
  EXPECT_EQ(node.sdo.timeout_of({0x1010, 1}, 500ms), 5s);
}

TEST(SdoAccess, TakesChannelBlockAndTimeOutsOfTheFile) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "nodes:\n"
      "  arm:\n"
      "    node_id: 5\n"
      "    dcf: x\n"
      "    sdo_block: never\n"
      "    sdo_channel: {request: 0x645, answer: 0x5C5}\n"
      "    sdo_timeouts: [{index: 0x1F50, timeout_ms: 20000},\n"
      "                   {index: 0x6081, sub_index: 0, timeout_ms: 3000}]\n"
      "    sdo: [{index: 0x6081, value: 7}]\n",
      eds_with_server("$NODEID+0x640", "$NODEID+0x5C0"));
  EXPECT_THAT(net.complaints(), IsEmpty());
  const NodePlan& node = net.plan.nodes.at(0);
  EXPECT_EQ(node.sdo.channel_of(node.id), (SdoChannel{CobId::base(0x645), CobId::base(0x5C5)}));
  EXPECT_EQ(node.sdo.block, SdoBlockUse::off);
  EXPECT_EQ(node.sdo.timeout_of({0x1F50, 3}, 500ms), 20s);
  EXPECT_EQ(node.sdo.timeout_of({0x6081, 1}, 500ms), 500ms);
  for (const BootStep& step : node.boot_plan.steps) {
    if (step.object == ObjectKey{0x6081, 0}) {
      EXPECT_EQ(step.timeout, 3s) << step.purpose;
    }
    if (step.object == ObjectKey{0x1018, 1}) {
      EXPECT_EQ(step.timeout, 500ms) << step.purpose;
    }
  }
}

TEST(SdoAccess, RefusesAChannelOfAnotherNode) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "nodes:\n"
      "  arm: {node_id: 5, dcf: x, sdo_channel: {request: 0x645, answer: 0x586}}\n"
      "  leg: {node_id: 6, dcf: x}\n");
  EXPECT_THAT(net.complaints(),
              ElementsAre("3:42 error [cob-id-clash]", "3:42 warning [no-sdo-server]"));
  EXPECT_THAT(net.declared("cob-id-clash"), HasSubstr("`leg` (0x606, 0x586)"));
}

TEST(SdoAccess, ReportsOfAChannelThatTheDeviceFileHasNoServerFor) {
  const auto net = compile(on_second);

  EXPECT_THAT(net.complaints(), ElementsAre("6:18 warning [no-sdo-server]"));
  EXPECT_THAT(net.declared("no-sdo-server"),
              HasSubstr("`sdo_channel` of node `arm`: tiny.eds has no SDO server besides the first "
                        "(no 0x1201 to 0x127F)"));
  EXPECT_THAT(net.declared("no-sdo-server"), HasSubstr("leave `sdo_channel` out"));
}

TEST(SdoAccess, ReportsOfAServerThatIsOffOrOnOtherIds) {
  EXPECT_THAT(compile(on_second, eds_with_server("$NODEID+0x80000640", "$NODEID+0x800005C0"))
                  .declared("no-sdo-server"),
              HasSubstr("no SDO server of tiny.eds is on 0x645 and 0x5C5 (0x1201: off)"));
  EXPECT_THAT(compile(on_second, eds_with_server("$NODEID+0x640", "$NODEID+0x6C0"))
                  .declared("no-sdo-server"),
              HasSubstr("(0x1201: 0x645 and 0x6C5)"));
  EXPECT_THAT(compile(on_second, eds_with_server("", "")).declared("no-sdo-server"),
              HasSubstr("(0x1201: off)"));
}

TEST(SdoAccess, TakesAChannelThatTheDeviceFileHas) {
  EXPECT_EQ(compile(on_second, eds_with_server("0x645", "0x5C5")).declared("no-sdo-server"), "");
  EXPECT_EQ(compile(on_channel("{request: 0x605, answer: 0x585}")).declared("no-sdo-server"), "");
}

TEST(SdoAccess, RefusesWhatIsIncompleteOrOutOfRange) {
  const auto net = compile(
      "nodes:\n"
      "  arm:\n"
      "    node_id: 5\n"
      "    dcf: x\n"
      "    sdo_block: sometimes\n"
      "    sdo_channel: {request: 0x645}\n"
      "    sdo_timeouts: [{index: 0x1F50}, {index: 0x1F50, timeout_ms: 0}]\n"
      "master: {sync_period: 10000, service_frames: 0}\n");
  EXPECT_EQ(net.complaints().size(), 5U);
}

TEST(SdoAccess, ServiceFramesAreSixteenInEachTenMilliseconds) {
  const auto frames = [](const std::string& period) {
    return compile("master: {sync_period: " + period + "}\nnodes: {arm: {node_id: 5, dcf: x}}\n")
        .plan.cycle.service_frames;
  };
  EXPECT_EQ(frames("10000"), 16);
  EXPECT_EQ(frames("19000"), 16);
  EXPECT_EQ(frames("40000"), 64);
  EXPECT_EQ(frames("49999"), 64);
  EXPECT_EQ(frames("50000"), 16);  // served every 10 ms
}

TEST(SdoAccess, ServiceFramesOfACycleCanBeChosen) {
  const auto net = compile(
      "master: {sync_period: 10000, service_frames: 40}\n"
      "nodes: {arm: {node_id: 5, dcf: x}}\n");
  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(net.plan.cycle.service_frames, 40);
}

}  // namespace
}  // namespace takt
