#include <algorithm>
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

const std::string mine = "name: Mine\nmanual: page 7\nmatch: {vendor_id: 0xABCD}\n";

std::string arm(const std::string& rest) { return "arm: {node_id: 5, dcf: x" + rest + "}\n"; }

test::Compiled with_value(const std::string& value, const std::string& rest = "") {
  return compile_with_entry(mine + "sdo: [{index: 0x2000, value: " + value + "}]\n", arm(rest));
}

TEST(DeviceDataValues, AreWrittenBeforeThoseOfTheNetworkFile) {
  const auto net = with_value("0x1234", ", sdo: [{index: 0x6081, value: 7}]");

  const auto steps = steps_of(net, {0x2000, 0});
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(steps[0].action, BootAction::write_if_differs);
  EXPECT_THAT(steps[0].value, ElementsAre(std::byte{0x34}, std::byte{0x12}));
  EXPECT_THAT(steps[0].purpose, HasSubstr("device data: 2000:00 Not mappable"));
  const auto& all = net.plan.nodes.at(0).boot_plan.steps;
  const auto at = [&](ObjectKey key) { return std::ranges::find(all, key, &BootStep::object); };
  EXPECT_LT(at({0x2000, 0}), at({0x6081, 0}));
  EXPECT_LT(at({0x6081, 0}), at({0x1600, 0}));
}

TEST(DeviceDataValues, GiveWayToThoseOfTheNetworkFile) {
  const auto steps = steps_of(with_value("1", ", sdo: [{index: 0x2000, value: 2}]"), {0x2000, 0});

  ASSERT_EQ(steps.size(), 1u);
  EXPECT_THAT(steps[0].value, ElementsAre(std::byte{2}, std::byte{0}));
}

TEST(DeviceDataValues, GiveWayToThoseOfADcf) {
  const std::string dcf =
      test::tiny_eds() + test::entry("2010", "Mine", 5, "rw", "0") + "ParameterValue=9\n";
  const auto net =
      compile_with_entry(mine + "sdo: [{index: 0x2010, value: 1}]\n", arm(""), dcf, "tiny.dcf");

  const auto steps = steps_of(net, {0x2010, 0});
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_THAT(steps[0].value, ElementsAre(std::byte{9}));
}

TEST(DeviceDataValues, ThatTheEdsDoesNotHaveAreLeftOutWithAWarning) {
  const auto net =
      compile_with_entry(mine + "sdo: [{index: 0x2F00, value: 1, reason: quirk}]\n", arm(""));

  EXPECT_THAT(
      net.declared("device-data"),
      HasSubstr("node `arm`: 2F00:00, which Mine requires takt to write, is not in tiny.eds: quirk "
                "(my_drive.yaml:4, after page 7)"));
  EXPECT_TRUE(steps_of(net, {0x2F00, 0}).empty());
  EXPECT_FALSE(has_error(net.findings));
  EXPECT_THAT(compile_with_entry(mine + "sdo: [{index: 0x6064, value: 1}]\n", arm(""))
                  .declared("device-data"),
              HasSubstr("6064:00, which Mine requires takt to write, is read-only in tiny.eds"));
}

TEST(DeviceDataValues, ThatDoNotFitTheirObjectAreAnError) {
  EXPECT_THAT(with_value("0x12345").declared("out-of-range"), HasSubstr("2000:00 Not mappable"));
}

TEST(DeviceDataValues, AreANoteOfThePlan) {
  EXPECT_THAT(with_value("3").plan.nodes.at(0).device_notes, ElementsAre("needs 2000:00 = 3"));
}

TEST(DeviceDataValues, OfALexium32AAreThoseForInterpolatedPosition) {
  const std::string eds = test::tiny_eds() + test::record("3006", "Motion", 2) +
                          test::entry("3006sub0", "highest", 5, "const", "0x3D") +
                          test::entry("3006sub3D", "compatibility", 6, "rw", "0");
  const auto net = compile_with_shipped(arm(", device: lexium32a"), eds);

  const auto steps = steps_of(net, {0x3006, 0x3D});
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_THAT(steps[0].value, ElementsAre(std::byte{1}, std::byte{0}));
}

TEST(DeviceDataValues, AreWrittenDownCompletely) {
  const std::string entry = "name: x\nmatch: none\n";
  EXPECT_THAT(errors_of_entry(entry + "sdo: [{index: 0x2000}]\n"), ElementsAre("3 missing-key"));
  EXPECT_THAT(errors_of_entry(entry + "sdo: [{value: 1}]\n"), ElementsAre("3 missing-key"));
  EXPECT_THAT(errors_of_entry(entry + "sdo: [{index: 0x1400, sub_index: 2, value: 1}]\n"),
              ElementsAre("3 wrong-object"));
  EXPECT_THAT(errors_of_entry(entry + "sdo: {index: 0x2000, value: 1}\n"),
              ElementsAre("3 wrong-type"));
}

TEST(DeviceDataTimeouts, AreThoseOfBootAndRequests) {
  const auto net =
      compile_with_entry(mine + "sdo_timeouts: [{index: 0x2000, timeout_ms: 3000}]\n",
                         arm(", sdo: [{index: 0x2000, value: 1}, {index: 0x6081, value: 1}]"));

  EXPECT_EQ(steps_of(net, {0x2000, 0}).at(0).timeout, 3s);
  EXPECT_EQ(steps_of(net, {0x6081, 0}).at(0).timeout, 500ms);
  EXPECT_EQ(net.plan.nodes.at(0).sdo.timeout_of({0x2000, 0}, 500ms), 3s);
}

TEST(DeviceDataTimeouts, GiveWayToTheNetworkFileButNeverShortenIt) {
  const std::string entry = mine + "sdo_timeouts: [{index: 0x2000, timeout_ms: 3000}]\n";
  const auto timeout = [&](const std::string& rest) {
    const auto net = compile_with_entry(entry, arm(rest));
    return net.plan.nodes.at(0).sdo.timeout_of({0x2000, 0}, 500ms);
  };

  EXPECT_EQ(timeout(", sdo_timeouts: [{index: 0x2000, timeout_ms: 800}]"), 800ms);
  EXPECT_EQ(timeout(", sdo_timeout_ms: 9000"), 9s);
  EXPECT_EQ(timeout(", sdo_timeout_ms: 900"), 3s);
}

TEST(DeviceDataTimeouts, OfAnNxpBootRomAreThoseOfErasing) {
  const auto net =
      compile_with_shipped("rom: {node_id: 125, dcf: x, boot: false, device: nxp_lpc_boot}\n");

  EXPECT_EQ(net.plan.nodes.at(0).sdo.timeout_of({0x5030, 0}, 500ms), 3s);
  EXPECT_EQ(net.plan.nodes.at(0).sdo.timeout_of({0x5020, 0}, 500ms), 500ms);
  EXPECT_THAT(net.plan.nodes.at(0).device_notes,
              ElementsAre("node ids 125", "0x5030: SDO time-out 3000 ms"));
}

TEST(DeviceDataTimeouts, AreWrittenDownCompletely) {
  const std::string entry = "name: x\nmatch: none\n";
  EXPECT_THAT(errors_of_entry(entry + "sdo_timeouts: [{index: 0x2000}]\n"),
              ElementsAre("3 missing-key"));
  EXPECT_THAT(errors_of_entry(entry + "sdo_timeouts: [{index: 0x2000, timeout_ms: 0}]\n"),
              ElementsAre("3 out-of-range"));
}

}  // namespace
}  // namespace takt
