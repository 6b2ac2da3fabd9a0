// Limits that the file does not give, and that the boot reads from the drive.
#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/limits/limited_drive.hpp"

namespace takt::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string limit_objects(const std::string& unsigned32 = "7") {
  const int type = std::stoi(unsigned32);
  return record("607D", "Software position limit", 3) +
         entry("607Dsub0", "highest", 5, "const", "2") +
         entry("607Dsub1", "min", 4, "rw", "-1000") + entry("607Dsub2", "max", 4, "rw", "2000") +
         entry("607F", "Max profile velocity", type, "rw", "500") +
         entry("60C5", "Max acceleration", type, "rw", "300");
}

Compiled telling_drive(const std::string& limits, const std::string& mapped,
                       const std::string& objects = limit_objects()) {
  return compile(
      "master: {sync_period: 2000}\nnodes:\n  arm:\n    node_id: 5\n    dcf: tiny.eds\n"
      "    rpdo: {2: {enabled: true, mapping: [" +
          mapped + "]}}\n" + std::string{units} + limits,
      tiny_eds() + objects);
}

/// Returns the objects of the steps that read limits.
std::vector<std::string> reads(const Compiled& net) {
  std::vector<std::string> objects;
  for (const BootStep& step : net.plan.nodes.at(0).boot_plan.steps) {
    if (step.action == BootAction::read_limit) objects.push_back(to_string(step.object));
  }
  return objects;
}

TEST(Limits, ThatTheFileDoesNotGiveAreReadInTheBootInCountsPerCycle) {
  const Compiled net = telling_drive("", "{index: 0x607A}");
  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_THAT(reads(net), ElementsAre("607D:01", "607D:02", "607F:00", "60C5:00"));
  ASSERT_EQ(net.plan.limits.device.size(), 3U);
  const auto& device = net.plan.limits.device;
  EXPECT_EQ(device[0].bound, DeviceBound::range);
  EXPECT_EQ(device[0].factor, 1.0);
  EXPECT_EQ(device[1].bound, DeviceBound::rate);
  EXPECT_DOUBLE_EQ(device[1].factor, 0.02);  // 0.01 rad/s x 2 ms / 1 mrad
  EXPECT_EQ(device[2].bound, DeviceBound::bend);
  EXPECT_DOUBLE_EQ(device[2].factor, 4e-4);  // 0.1 rad/s^2 x (2 ms)^2 / 1 mrad
  EXPECT_EQ(only(net).high, OutputLimit::none);
  EXPECT_EQ(only(net).range, LimitKind::position);
  EXPECT_THAT(
      text_of(net),
      AllOf(
          HasSubstr("arm  position      as the device says rad      read from the device at boot, "
                    "607D:01\n"),
          HasSubstr("arm  velocity      as the device says rad/s    read from the device at boot, "
                    "607F:00\n"),
          HasSubstr("arm  acceleration  as the device says rad/s^2  read from the device at boot, "
                    "60C5:00\n")));
  EXPECT_THAT(json_of(net), HasSubstr(R"("source": "device")"));
}

TEST(Limits, OfTheDeviceAreReadOnceForSeveralOutputsAndBoundVelocities) {
  const Compiled net = telling_drive("", "{index: 0x60FF}, {index: 0x607A}");
  EXPECT_THAT(reads(net), ElementsAre("607D:01", "607D:02", "607F:00", "60C5:00"));
  ASSERT_EQ(net.plan.limits.device.size(), 5U);
  EXPECT_EQ(net.plan.limits.device[2].bound, DeviceBound::size);
  EXPECT_EQ(net.plan.limits.device[2].factor, 1.0);
  EXPECT_EQ(net.plan.limits.device[4].bound, DeviceBound::rate);
  EXPECT_DOUBLE_EQ(net.plan.limits.device[4].factor, 0.02);  // 0.1 rad/s^2 x 2 ms / 0.01 rad/s
}

TEST(Limits, OfTheDeviceBoundTheVelocityAndTheAccelerationOfAProfile) {
  for (const int index : {0x6081, 0x6083}) {
    const Compiled net =
        telling_drive("", "{index: 0x607A}, {index: " + std::to_string(index) + "}",
                      limit_objects() + entry("6083", "Profile acceleration", 7, "rw", "1", true));
    EXPECT_THAT(reads(net), ElementsAre("607D:01", "607D:02", "607F:00", "60C5:00"));
    ASSERT_EQ(net.plan.limits.outputs.size(), 2U);
    const OutputLimit& limit = net.plan.limits.outputs[1];
    EXPECT_EQ(limit.range, index == 0x6081 ? LimitKind::velocity : LimitKind::acceleration);
    const auto bound =
        std::ranges::find(net.plan.limits.device, limit.signal, &DeviceLimit::signal);
    ASSERT_NE(bound, net.plan.limits.device.end());
    EXPECT_EQ(bound->bound, DeviceBound::size);
    EXPECT_EQ(bound->factor, 1.0);
  }
}

TEST(Limits, OfTheFileSpareTheBootTheReading) {
  EXPECT_THAT(
      reads(telling_drive("    limits: {position: [-1, 1], velocity: 2, acceleration: 20}\n",
                          "{index: 0x607A}")),
      IsEmpty());
  EXPECT_THAT(reads(telling_drive("    limits: {position: [-1, 1]}\n", "{index: 0x607A}")),
              ElementsAre("607F:00", "60C5:00"));
}

TEST(Limits, AreNotReadWhereTheDeviceFileHasNoneOf32BitsOrNothingShowsThem) {
  EXPECT_THAT(reads(telling_drive("", "{index: 0x607A}", "")), IsEmpty());
  EXPECT_THAT(reads(telling_drive("", "{index: 0x607A}", limit_objects("6"))),
              ElementsAre("607D:01", "607D:02"));
  EXPECT_THAT(reads(telling_drive("", "{index: 0x2003}")), IsEmpty());
}

TEST(QuickStopOption, IsReadInTheBootOfADriveThatHasIt) {
  const std::string option = entry("605A", "Quick stop option code", 3, "rw", "2");
  EXPECT_THAT(reads(telling_drive("", "{index: 0x2003}", option)), ElementsAre("605A:00"));
  EXPECT_THAT(
      reads(telling_drive("    sdo: [{index: 0x605A, value: 2}]\n", "{index: 0x2003}", option)),
      ElementsAre("605A:00"))
      << "a device may keep another value, and a configuration date may spare the write";
  EXPECT_THAT(reads(telling_drive("    profile: none\n", "{index: 0x2003}", option)), IsEmpty());
}

}  // namespace
}  // namespace takt::test
