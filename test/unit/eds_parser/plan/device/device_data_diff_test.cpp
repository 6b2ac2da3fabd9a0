#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eds_parser/print/plan/plan_diff.hpp"
#include "test/unit/eds_parser/plan/device/device_data_network.hpp"

namespace takt {
namespace {

using test::compile;
using test::compile_with_entry;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Returns the difference as `takt plan --diff-devices` shows it.
std::string diff(const std::string& edits, const std::string& rest = "") {
  const std::string yaml =
      "master: {node_id: 127, heartbeat_producer: 101}\narm: {node_id: 5, dcf: x" + rest + "}\n";
  const auto without = compile(yaml);
  const auto with =
      compile_with_entry("name: Mine\nmatch: {vendor_id: 0xABCD}\n" + edits + "\n", yaml);
  return node_diff({without.plan, "without"}, {with.plan, "mine"}, with.plan.nodes.at(0).id);
}

TEST(DeviceDataDiff, ShowsRoundedHeartbeats) {
  EXPECT_THAT(diff("heartbeat: {multiple_of_ms: 5}"),
              AllOf(HasSubstr("+    heartbeat times in steps of 5 ms, rounded down\n"),
                    HasSubstr("watches the master (node 127) for 303 ms\n+"),
                    HasSubstr("watches the master (node 127) for 305 ms\n")));
}

TEST(DeviceDataDiff, ShowsValues) {
  EXPECT_THAT(
      diff("sdo: [{index: 0x2000, value: 7}]"),
      AllOf(HasSubstr("+    needs 2000:00 = 7\n"), HasSubstr("+  J write if differs   605#"),
            HasSubstr("device data: 2000:00 Not mappable\n")));
}

TEST(DeviceDataDiff, ShowsTimeOuts) {
  EXPECT_THAT(diff("sdo_timeouts: [{index: 0x1017, sub_index: 0, timeout_ms: 2000}]"),
              AllOf(HasSubstr("+    1017:00: SDO time-out 2000 ms\n"),
                    HasSubstr("<2000 ms  heartbeat every"), HasSubstr("<500 ms  heartbeat every")));
}

TEST(DeviceDataDiff, ShowsRulesThatOnlyRefuse) {
  const std::string text = diff("node_ids: {range: [1, 63]}\ntpdo: [{no_gaps: true}]");

  EXPECT_THAT(text, AllOf(HasSubstr("+    node ids 1..63\n"),
                          HasSubstr("+    TPDOs: only together with the PDO before\n")));
  EXPECT_THAT(text, Not(HasSubstr("boot of node"))) << "not a frame differs";
}

}  // namespace
}  // namespace takt
