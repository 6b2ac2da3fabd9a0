#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "eds_parser/print/plan/print_plan.hpp"
#include "test/unit/eds_parser/plan/boot/boot_text.hpp"

namespace takt {
namespace {

using test::arm;
using test::compile;
using test::entry;
using test::part;
using test::record;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string homing_objects() {
  return entry("6098", "Homing method", 2, "rw", "0") + record("6099", "Homing speeds", 3) +
         entry("6099sub0", "highest", 5, "const", "2") +
         entry("6099sub1", "Search for switch", 7, "rw", "1") +
         entry("6099sub2", "Search for zero", 7, "rw", "1") +
         entry("609A", "Homing acceleration", 7, "rw", "1") +
         entry("607C", "Home offset", 4, "rw", "0");
}

std::string methods(std::string_view first, std::string_view second) {
  return record("60E3", "Supported homing methods", 3) +
         entry("60E3sub0", "highest", 5, "ro", "2") + entry("60E3sub1", "first", 2, "ro", first) +
         entry("60E3sub2", "second", 2, "ro", second);
}

std::string drive() { return test::tiny_eds() + homing_objects(); }

constexpr std::string_view units =
    "units: {position: {scale: 0.001, unit: rad, offset: 7, sign: -1}, "
    "velocity: {scale: 0.01, unit: rad/s}, acceleration: {scale: 0.1, unit: rad/s^2}}, ";

TEST(BootHoming, WritesWhatIsGivenInTheUnitsOfTheNode) {
  const auto net =
      compile(arm(std::string{units} + "homing: {method: -3, speed_switch: 0.5, speed_zero: 0.05, "
                                       "acceleration: 5, offset: 0.25, timeout: 30000}"),
              drive());

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_THAT(
      part(net, "write if differs 6098:00 0xFD", 5),
      ElementsAre("write if differs 6098:00 0xFD", "write if differs 6099:01 0x00000032",
                  "write if differs 6099:02 0x00000005", "write if differs 609A:00 0x00000032",
                  "write if differs 607C:00 0xFFFFFF06"))
      << "the home offset is a difference: the offset of positions does not count";
  ASSERT_TRUE(net.plan.nodes[0].axes.at(0).homing);
  EXPECT_TRUE(net.plan.nodes[0].axes[0].homing->required);
  EXPECT_EQ(net.plan.nodes[0].axes[0].homing->timeout, std::chrono::seconds{30});
}

TEST(BootHoming, ANumberIsTheMethodAndNothingElseIsWritten) {
  const auto net = compile(arm("homing: 35"), drive());

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_THAT(test::steps(net), Contains("write if differs 6098:00 0x23"));
  EXPECT_THAT(test::steps(net), Not(Contains(HasSubstr("6099"))));
  EXPECT_EQ(net.plan.nodes[0].axes.at(0).homing->timeout, std::chrono::seconds{60});
}

TEST(BootHoming, WithoutTheKeyNothingIsRequiredOrWritten) {
  const auto net = compile(arm(), drive());

  EXPECT_FALSE(net.plan.nodes[0].axes.at(0).homing);
  EXPECT_THAT(test::steps(net), Not(Contains(HasSubstr("6098"))));
}

TEST(BootHoming, AnAxisOfADeviceMayDiffer) {
  const std::string eds = drive() + entry("6840", "Controlword 2", 6, "rww", "0", true) +
                          entry("6898", "Homing method 2", 2, "rw", "0");
  const auto net =
      compile(arm("homing: {method: 35, axes: {2: {method: 37, required: false}}}"), eds);

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_THAT(test::steps(net), Contains("write if differs 6098:00 0x23"));
  EXPECT_THAT(test::steps(net), Contains("write if differs 6898:00 0x25"));
  EXPECT_TRUE(net.plan.nodes[0].axes.at(0).homing->required);
  EXPECT_FALSE(net.plan.nodes[0].axes.at(1).homing->required);
}

TEST(BootHoming, WarnsOfAMethodThatTheDeviceDoesNotList) {
  const auto listed = compile(arm("homing: -1"), drive() + methods("35", "0xFF"));
  const auto other = compile(arm("homing: 17"), drive() + methods("35", "-1"));

  EXPECT_THAT(listed.complaints(), IsEmpty());
  EXPECT_THAT(other.declared("homing-method"),
              HasSubstr("lists the methods 35, -1 in 60E3:00, and not 17"));
  EXPECT_THAT(test::steps(other), Contains("write if differs 6098:00 0x11"));
}

TEST(BootHoming, WarnsOfADriveWithoutHomingModeUnlessHomingIsNotRequired) {
  const std::string eds = drive() + entry("6502", "Supported drive modes", 7, "ro", "0x81");

  EXPECT_THAT(compile(arm("homing: 35"), eds).declared("homing"),
              HasSubstr("the drive has no homing mode"));
  EXPECT_THAT(compile(arm("homing: {required: false}"), eds).complaints(), IsEmpty());
}

TEST(BootHoming, SaysWhatIsWrong) {
  const auto without = compile(arm("homing: {method: 35, offset: 2}"));
  EXPECT_THAT(without.declared("no-such-object"),
              HasSubstr("`homing: {method}` of node `arm` needs 6098:00"));
  EXPECT_THAT(without.declared("no-such-object"),
              HasSubstr("`homing: {offset}` of node `arm` needs 607C:00"));

  const auto twice = compile(arm("homing: 35, sdo: [{index: 0x6098, value: 1}]"), drive());
  EXPECT_THAT(twice.declared("written-twice"), HasSubstr("`arm` both write 6098:00: keep one"));

  const auto large = compile(arm("homing: {speed_zero: 3.0e+9}"), drive());
  EXPECT_THAT(large.declared("out-of-range"), HasSubstr("6099:02 would be above 0x7FFFFFFF"));
  const auto small = compile(arm("homing: {speed_zero: 0.1}"), drive());
  EXPECT_THAT(small.declared("out-of-range"), HasSubstr("becomes 0"));
  const auto negative = compile(arm("homing: {speed_zero: -1}"), drive());
  EXPECT_THAT(negative.declared("out-of-range"), HasSubstr("has to be above 0"));

  const auto no_axis = compile(arm("homing: {axes: {3: {method: 35}}}"), drive());
  EXPECT_THAT(no_axis.declared("homing"), HasSubstr("has no axis 3"));
  const auto no_map = compile(arm("homing: {axes: 3}"), drive());
  EXPECT_THAT(no_map.declared("wrong-type"), HasSubstr("map of axis numbers"));
  const auto no_drive = compile(arm("profile: none, homing: 35"), drive());
  EXPECT_THAT(no_drive.declared("homing"), HasSubstr("the node is no CiA 402 drive"));
}

TEST(BootHoming, ThePlanShowsIt) {
  const auto net = compile(arm("homing: {method: 35, timeout: 30000}"), drive());
  std::ostringstream text;
  print_plan_text(text, net.plan, {});
  std::ostringstream json;
  print_plan_json(json, net.plan, {});

  EXPECT_THAT(text.str(),
              HasSubstr("homing: required before absolute motions, method 35, at most"));
  EXPECT_THAT(json.str(), HasSubstr("\"timeout_us\": 30000000"));
}

}  // namespace
}  // namespace takt
