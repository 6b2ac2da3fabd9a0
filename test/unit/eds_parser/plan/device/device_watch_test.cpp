#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "eds_parser/print/plan/print_plan.hpp"
#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::compile;
using test::entry;
using test::record;

TEST(DeviceWatch, IsWhatTheBootWritesTo1016) {
  const auto net = compile(
      "options: {heartbeat_multiplier: 2}\nmaster: {node_id: 1, heartbeat_producer: 500}\n"
      "arm: {node_id: 5, dcf: x}\n");

  const auto& watches = net.plan.nodes.at(0).watches;
  ASSERT_EQ(watches.size(), 1U);
  EXPECT_EQ(watches[0].producer.value(), 1);
  EXPECT_EQ(watches[0].longest, 1000ms);
}

TEST(DeviceWatch, AnSdoOfTheNetworkFileCountsToo) {
  const auto net = compile(
      "master: {node_id: 1}\n"
      "arm: {node_id: 5, dcf: x, sdo: [{index: 0x1016, sub_index: 1, value: 0x00090078}]}\n");

  const auto& watches = net.plan.nodes.at(0).watches;
  ASSERT_EQ(watches.size(), 1U);
  EXPECT_EQ(watches[0].producer.value(), 9);
  EXPECT_EQ(watches[0].longest, 120ms);
}

TEST(DeviceWatch, WithoutAHeartbeatOfTheMasterNobodyWatches) {
  const auto net = compile("master: {heartbeat_producer: 0}\narm: {node_id: 5, dcf: x}\n");

  EXPECT_TRUE(net.plan.nodes.at(0).watches.empty());
  EXPECT_EQ(net.plan.nodes.at(0).life_guarding, 0ms);
}

TEST(DeviceWatch, LifeGuardingIsTheGuardTimeSoOften) {
  const std::string eds = test::tiny_objects() + entry("100C", "guard time", 6, "rw", "0") +
                          entry("100D", "life time factor", 5, "rw", "0");
  const auto net = compile(
      "master: {heartbeat_producer: 0}\n"
      "arm: {node_id: 5, dcf: x, heartbeat_producer: 0, guard_time: 200, life_time_factor: 4}\n",
      eds);

  EXPECT_EQ(net.plan.nodes.at(0).life_guarding, 800ms);
}

TEST(DeviceWatch, ANodeThatIsOnlyWatchedAndHasNoHeartbeatIsDeclaredToGoUnnoticed) {
  const auto net = compile("nodes: {arm: {node_id: 5, dcf: x, boot: false}}\n");

  std::ostringstream text;
  print_plan_text(text, net.plan, {.node = {}, .realtime = {}, .lcm = {}});
  EXPECT_THAT(
      text.str(),
      testing::HasSubstr(
          "only watched: no NMT, no SDO, no heartbeat: the master does not notice its loss\n"));
}

}  // namespace
}  // namespace takt
