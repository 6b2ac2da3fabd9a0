#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/plan/tiny_network.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::compile;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

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
      "    sdo: [{index: 0x6081, value: 7}]\n");
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
  EXPECT_THAT(net.complaints(), ElementsAre("3:42 error [cob-id-clash]"));
  EXPECT_THAT(net.said("cob-id-clash"), HasSubstr("`leg` (0x606, 0x586)"));
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
  EXPECT_EQ(net.complaints().size(), 6U);
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
