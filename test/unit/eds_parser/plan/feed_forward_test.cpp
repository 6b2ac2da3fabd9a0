// The key `feed_forward` of a node.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eds_parser/table/motion_axes.hpp"
#include "test/unit/eds_parser/plan/limits/limited_drive.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;

constexpr std::string_view with_torque =
    "    units: {position: {scale: 0.001, unit: rad}, torque: {scale: 0.001, unit: Nm}}\n";

Compiled drive_with(const std::string& keys, const std::string& mapped = ", {index: 0x60B2}",
                    std::string_view its_units = with_torque) {
  return drive("    profile: cia402\n" + keys, "{index: 0x607A}" + mapped, its_units,
               tiny_eds() + entry("60B2", "Torque offset", 3, "rww", "0", true));
}

std::string found(const Compiled& net) {
  std::string text;
  for (const Finding& f : net.findings) {
    if (f.rule == "feed-forward") text += std::string{name(f.severity)} + ": " + f.message + "\n";
  }
  return text;
}

TEST(FeedForward, IsThatOfTheAxis) {
  const Compiled net = drive_with(
      "    feed_forward: {torque_per_acceleration: 0.004, torque_per_velocity: 0.01, axes: {1: "
      "{torque_per_velocity: 0.02}}}\n");
  EXPECT_EQ(found(net), "");
  const MotionAxis axis = motion_axes(net.plan).at(0);
  ASSERT_TRUE(axis.torque_offset.has_value());
  EXPECT_EQ(net.plan.layout.signals[*axis.torque_offset].object.index, 0x60B2);
  EXPECT_EQ(axis.feed_forward.torque_per_acceleration, 0.004);
  EXPECT_EQ(axis.feed_forward.torque_per_velocity, 0.02);
}

TEST(FeedForward, WithoutTheKeyATorqueOffsetIsLeftToTheApplication) {
  const Compiled net = drive_with("");
  EXPECT_THAT(found(net), HasSubstr("note: 60B2:00 (torque offset) of `arm` is in an RPDO, but the "
                                    "motions of taktd do not command it"));
  EXPECT_FALSE(motion_axes(net.plan).at(0).torque_offset.has_value());
  EXPECT_EQ(found(drive_with("", "")), "");
}

TEST(FeedForward, WithoutEffectOrUnitIsReported) {
  const std::string key = "    feed_forward: {torque_per_acceleration: 0.004}\n";
  EXPECT_THAT(found(drive_with(key, "")),
              HasSubstr("warning: `feed_forward` of `arm` has no effect"));
  EXPECT_THAT(found(drive_with(key, ", {index: 0x60B2}",
                               "    units: {position: {scale: 0.001, unit: rad}}\n")),
              HasSubstr("error: `feed_forward` of `arm`: 60B2:00 has no unit"));
}

}  // namespace
}  // namespace takt::test
