#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using test::compile;
using test::entry;
using testing::HasSubstr;

const std::string guarding = "guard_time: 200, life_time_factor: 4, retry_factor: 2";

std::string network(const std::string& node, const std::string& master = "node_id: 1") {
  return "master: {" + master + "}\narm: {node_id: 5, dcf: x, " + node + "}\n";
}

std::string with_guarding() {
  return test::tiny_objects() + entry("100C", "guard time", 6, "rw", "0") +
         entry("100D", "life time factor", 5, "rw", "0");
}

std::ptrdiff_t complaints_of(std::string_view rule, const test::Compiled& net) {
  return std::ranges::count_if(net.findings, [&](const Finding& finding) {
    return finding.rule == rule && finding.severity != Severity::note;
  });
}

TEST(GuardingFindings, EachKeyIsLeftAloneBesideAHeartbeat) {
  const std::string declared = compile(network(guarding), with_guarding()).declared("guarding");

  for (const auto* key : {"`guard_time`", "`life_time_factor`", "`retry_factor`"}) {
    EXPECT_THAT(declared, HasSubstr("(CiA 301): " + std::string{key} + " has no effect"));
  }
}

TEST(GuardingFindings, WhyANodeIsNotGuarded) {
  const std::string off = "heartbeat_producer: 0, ";
  const auto declared = [&](const std::string& node, const std::string& master = "node_id: 1") {
    return compile(network(node, master), with_guarding()).declared("guarding");
  };

  EXPECT_THAT(declared(off + "life_time_factor: 3"),
              HasSubstr("no guard time, neither in the network file nor in tiny.eds: "
                        "`life_time_factor` has no effect"));
  EXPECT_THAT(declared(off + "guard_time: 100, retry_factor: 0"),
              HasSubstr("(`retry_factor: 0`): `guard_time` has no effect"));
  EXPECT_THAT(declared(off + guarding, "heartbeat_consumer: false"),
              HasSubstr("(`heartbeat_consumer: false` of `master`): `guard_time` has no effect"));
  EXPECT_THAT(declared("boot: false, " + guarding),
              HasSubstr("(`boot: false`): `guard_time` has no effect"));
  EXPECT_EQ(declared(off + "guard_time: 0, life_time_factor: 0"), "");
}

TEST(GuardingFindings, NothingIsDeclaredOfADeviceThatTakesIt) {
  const auto net = compile(network("heartbeat_producer: 0, " + guarding), with_guarding());

  EXPECT_EQ(net.declared("guarding") + net.declared("guard-object"), "");
}

TEST(GuardingFindings, ADeviceWithoutTheObjectsIsReported) {
  const auto net = compile(network("heartbeat_producer: 0, " + guarding));

  EXPECT_EQ(net.plan.nodes.at(0).guard.retries, 2);
  EXPECT_THAT(net.declared("guard-object"), HasSubstr("tiny.eds has no writable 100C:00"));
  EXPECT_THAT(net.declared("guard-object"),
              HasSubstr("needs 100D:00, which tiny.eds does not have"));
  EXPECT_EQ(complaints_of("guard-object", net), 1) << "the device that does not watch the master";
}

TEST(GuardingFindings, AFactorOfNoneNeedsNoObject) {
  const auto net = compile(network("heartbeat_producer: 0, guard_time: 200, life_time_factor: 0"));

  EXPECT_EQ(complaints_of("guarding", net) + complaints_of("guard-object", net), 0);
  EXPECT_THAT(net.declared("guarding"), HasSubstr("does not need `life_time_factor: 0`"));
}

}  // namespace
}  // namespace takt
