#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eds_parser/network_file/load_network.hpp"
#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::compile;
using testing::AllOf;
using testing::HasSubstr;

constexpr ObjectKey cob_id_sync{0x1005, 0};
constexpr ObjectKey period{0x1006, 0};

const LoadedNetwork& demo() {
  static const LoadedNetwork network =
      load_network(TAKT_SOURCE_DIR "/share/demo/lenze8400_sync.yaml");
  return network;
}

std::vector<const BootStep*> steps_of(const NodePlan& node, ObjectKey object) {
  std::vector<const BootStep*> found;
  for (const BootStep& step : node.boot_plan.steps) {
    if (step.object == object) found.push_back(&step);
  }
  return found;
}

TEST(SyncSource, IsTheMasterWhereNobodySaysOtherwise) {
  const auto net = compile("master: {sync_period: 10000}\nnodes: {arm: {node_id: 5, dcf: x}}\n");
  EXPECT_TRUE(net.plan.cycle.makes_sync());
  EXPECT_FALSE(net.plan.cycle.sync_followed);
}

TEST(SyncSource, IsTheNodeOfTheFile) {
  EXPECT_FALSE(has_error(demo().findings));
  const CyclePlan& cycle = demo().plan.cycle;
  EXPECT_FALSE(cycle.makes_sync());
  EXPECT_EQ(cycle.sync_producer, NodeId::from(3));
  EXPECT_EQ(cycle.sync_timeout, 15ms);
  EXPECT_EQ(cycle.on_sync_loss, SyncLoss::fallback);
}

TEST(SyncSource, IsReportedToProduceAfterItHasItsPeriod) {
  const NodePlan& producer = demo().plan.nodes.at(0);
  const auto identifiers = steps_of(producer, cob_id_sync);
  ASSERT_EQ(identifiers.size(), 2u);
  using Bytes = std::vector<std::byte>;
  EXPECT_EQ(identifiers[1]->value,
            (Bytes{std::byte{0x80}, std::byte{0x00}, std::byte{0x00}, std::byte{0x40}}));
  ASSERT_FALSE(steps_of(producer, period).empty());
  EXPECT_GT(identifiers[1], steps_of(producer, period).back()) << "bit 30 comes last";

  const auto of_axis = steps_of(demo().plan.nodes.at(1), cob_id_sync);
  ASSERT_EQ(of_axis.size(), 1u);
  EXPECT_THAT(of_axis[0]->purpose, HasSubstr("SYNC comes from conveyor"));
}

TEST(SyncSource, HasATimeOutOfOneAndAHalfPeriods) {
  const auto net = compile(
      "master: {sync_period: 10000, sync_source: external}\n"
      "nodes: {arm: {node_id: 5, dcf: x}}\n");
  EXPECT_EQ(net.plan.cycle.sync_timeout, 15ms);
  EXPECT_FALSE(net.plan.cycle.sync_producer);
}

TEST(SyncSource, IsAllowedToBeEarlyByATwentiethOfThePeriod) {
  const std::string nodes = "nodes: {arm: {node_id: 5, dcf: x}}\n";
  const auto own = compile("master: {sync_period: 10000}\n" + nodes);
  const auto foreign = compile("master: {sync_period: 10000, sync_source: external}\n" + nodes);
  EXPECT_EQ(foreign.plan.cycle.output_deadline, own.plan.cycle.output_deadline - 500us);
  EXPECT_EQ(foreign.plan.cycle.quiet_before_sync, own.plan.cycle.quiet_before_sync + 500us);
}

TEST(SyncSource, IsRefusedWhereItIsNoNodeOrHasNoPeriod) {
  const std::string nodes = "nodes: {arm: {node_id: 5, dcf: x}}\n";
  EXPECT_THAT(
      compile("master: {sync_period: 10000, sync_source: amr}\n" + nodes).declared("sync-source"),
      HasSubstr("`sync_source: amr`: there is no such node"));
  EXPECT_THAT(compile("master: {sync_source: external}\n" + nodes).declared("sync-source"),
              HasSubstr("needs `sync_period`"));
  EXPECT_THAT(compile("master: {sync_period: 10000, sync_timeout: 15000}\n" + nodes)
                  .declared("sync-source"),
              HasSubstr("`sync_timeout` is for a SYNC that another device produces"));
}

TEST(SyncSource, IsRefusedWhereTheNodeCannotBeConfiguredToProduceIt) {
  std::string eds = test::tiny_eds();
  const std::string writable = "DataType=0x0007\nAccessType=rw\nDefaultValue=0x80\n";
  eds.replace(eds.find(writable), writable.size(),
              "DataType=0x0007\nAccessType=ro\nDefaultValue=0x80\n");
  const auto declared = [&](const std::string& keys, const std::string& device) {
    return compile(
               "master: {sync_period: 10000, sync_source: arm}\n"
               "nodes: {arm: {node_id: 5, dcf: x" +
                   keys + "}}\n",
               device)
        .declared("sync-source");
  };
  EXPECT_THAT(declared("", eds), AllOf(HasSubstr("can't produce SYNC"), HasSubstr("1005:00")));
  EXPECT_EQ(declared(", boot: false", eds), "") << "another tool configures the node";
  EXPECT_EQ(declared("", test::tiny_eds()), "");
}

TEST(TimeOfDayKeys, GiveAPeriodAndAnIdentifier) {
  const std::string nodes = "nodes: {arm: {node_id: 5, dcf: x}}\n";
  EXPECT_EQ(compile(nodes).plan.time.period, 0ns);
  const auto by_flag = compile("master: {time_cob_id: 0x40000100}\n" + nodes);
  EXPECT_EQ(by_flag.plan.time.period, 1s);
  EXPECT_EQ(by_flag.plan.time.cob_id, CobId::base(0x100));
  const auto by_period = compile("master: {time_period: 500, time_cob_id: 0x220}\n" + nodes);
  EXPECT_EQ(by_period.plan.time.period, 500ms);
  EXPECT_EQ(by_period.plan.time.cob_id, CobId::base(0x220));
  EXPECT_THAT(
      compile("master: {time_period: 500, time_cob_id: 0x123}\n" + nodes).declared("cob-id"),
      HasSubstr("is reserved by CiA 301"));
}

TEST(TimeOfDayKeys, MayHaveAReservedIdentifierOnlyIfTheMasterDoesNotSendTime) {
  const auto declared = [](const std::string& keys) {
    return compile("master: {time_cob_id: 0x123" + keys + "}\nnodes: {arm: {node_id: 5, dcf: x}}\n")
        .declared("cob-id");
  };
  EXPECT_EQ(declared(""), "");
  EXPECT_THAT(declared(", time_period: 1"), HasSubstr("0x123"));
}

TEST(TimeOfDayKeys, OfANodeAreWrittenFirstWithoutAndThenWithTheBitOfTheConsumer) {
  for (const int type : {7, 9}) {  // UNSIGNED32, and a type without a width, which is wrong here
    const auto net =
        compile("nodes: {arm: {node_id: 5, dcf: x, time_cob_id: 0x80000100}}\n",
                test::tiny_eds() + test::entry("1012", "COB-ID TIME", type, "rw", "0x100"));
    const auto found = steps_of(net.plan.nodes.at(0), {0x1012, 0});
    ASSERT_EQ(found.size(), 2U) << type;
    using Bytes = std::vector<std::byte>;
    EXPECT_EQ(found[0]->value, (Bytes{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}}));
    EXPECT_EQ(found[1]->value, (Bytes{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0x80}}));
  }
}

}  // namespace
}  // namespace takt
