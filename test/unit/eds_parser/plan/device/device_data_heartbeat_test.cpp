#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/device/device_data_network.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::compile_with_entry;
using test::compile_with_shipped;
using test::errors_of_entry;
using test::steps_of;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto byte = [](unsigned value) { return std::byte{static_cast<std::uint8_t>(value)}; };

/// Compiles a network with a drive that counts heartbeat times in units of 5 ms.
test::Compiled drive(const std::string& rest, const std::string& master = "") {
  return compile_with_shipped("master: {node_id: 127, sync_period: 10000" + master +
                              "}\narm: {node_id: 5, dcf: x, device: lenze9400" + rest + "}\n");
}

TEST(DeviceDataHeartbeat, OfTheMasterIsAwaitedForAMultiple) {
  const auto net = drive("", ", heartbeat_producer: 101, heartbeat_multiplier: 2");

  // 202 ms, which the drive would make 200: less than two heartbeats of the master
  const auto steps = steps_of(net, {0x1016, 1});
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_THAT(steps[0].value, ElementsAre(byte(205), byte(0), byte(127), byte(0)));
  ASSERT_EQ(net.plan.nodes[0].watches.size(), 1u);
  EXPECT_EQ(net.plan.nodes[0].watches[0].longest, 205ms);
}

TEST(DeviceDataHeartbeat, OfTheMasterThatIsAMultipleIsLeftAlone) {
  const auto steps = steps_of(drive(""), {0x1016, 1});

  ASSERT_EQ(steps.size(), 1u);
  EXPECT_THAT(steps[0].value, ElementsAre(byte(0x2C), byte(1), byte(127), byte(0)));  // 300 ms
}

TEST(DeviceDataHeartbeat, OfTheMasterStaysWithinSixteenBits) {
  const auto net = compile_with_entry(
      "name: Slow\nmatch: {vendor_id: 0xABCD}\nheartbeat: {multiple_of_ms: 1000}\n",
      "master: {node_id: 127, heartbeat_producer: 65000}\narm: {node_id: 5, dcf: x}\n");

  const auto steps = steps_of(net, {0x1016, 1});
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_THAT(steps[0].value, ElementsAre(byte(0xE8), byte(0xFD), byte(127), byte(0)));  // 65000
}

TEST(DeviceDataHeartbeat, OfTheDeviceIsPlannedAsItKeepsIt) {
  const auto net = drive(", heartbeat_producer: 104");

  const auto steps = steps_of(net, {0x1017, 0});
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_THAT(steps[0].value, ElementsAre(byte(100), byte(0)));
  EXPECT_EQ(net.plan.nodes[0].heartbeat_period, 100ms);
  EXPECT_EQ(net.plan.nodes[0].heartbeat_timeout, 300ms);
  EXPECT_THAT(
      net.declared("device-data"),
      HasSubstr("`heartbeat_producer` of node `arm` is 104 ms; Lenze 9400 counts in steps of 5 ms "
                "and rounds this time down to 100 ms: the times of 0x1016 and 0x1017"));
  EXPECT_FALSE(has_error(net.findings));
}

TEST(DeviceDataHeartbeat, ThatTheDeviceTakesForNoneIsRefused) {
  const auto net = drive(", heartbeat_producer: 4");

  EXPECT_THAT(net.declared("device-data"),
              HasSubstr("is 4 ms; Lenze 9400 counts in steps of 5 ms and "
                        "rounds this time down to 0, which means off"));
  EXPECT_TRUE(has_error(net.findings));
  EXPECT_EQ(drive(", heartbeat_producer: 0").declared("device-data"), "");
}

TEST(DeviceDataHeartbeat, OfAnSdoEntryIsJudgedToo) {
  const auto declared = [](const std::string& object, const std::string& value) {
    return drive(", sdo: [{" + object + ", value: " + value + "}]").declared("device-data");
  };

  EXPECT_THAT(declared("index: 0x1016, sub_index: 1", "0x00090067"),
              HasSubstr("1016:01 is 103 ms; Lenze 9400 counts in steps of 5 ms and rounds this "
                        "time down to 100 ms"));
  EXPECT_THAT(declared("index: 0x1017", "7"), HasSubstr("1017:00 is 7 ms"));
  EXPECT_EQ(declared("index: 0x1016, sub_index: 1", "0x00090064"), "");
  EXPECT_EQ(declared("index: 0x2000", "7"), "");
}

TEST(DeviceDataHeartbeat, OfALenze8400IsRoundedToo) {
  EXPECT_THAT(test::lenze8400("heartbeat_producer: 107").declared("device-data"),
              HasSubstr("rounds this time down to 105 ms"));
}

TEST(DeviceDataHeartbeat, NeedsItsStep) {
  const std::string entry = "name: x\nmatch: none\n";
  EXPECT_THAT(errors_of_entry(entry + "heartbeat: {}\n"), ElementsAre("3 missing-key"));
  EXPECT_THAT(errors_of_entry(entry + "heartbeat: {multiple_of_ms: 0}\n"),
              ElementsAre("3 out-of-range"));
  EXPECT_THAT(errors_of_entry(entry + "heartbeat: {multiple: 5}\n"), ElementsAre("3 unknown-key"));
}

}  // namespace
}  // namespace takt
