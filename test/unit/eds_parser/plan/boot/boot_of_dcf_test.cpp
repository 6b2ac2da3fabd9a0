#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/boot/boot_text.hpp"

namespace takt {
namespace {

using test::arm;
using test::compile;
using test::part;
using test::step_at;
using test::steps;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Makes a DCF of the tiny drive with these values, such as {"[1006]", "2000"}.
std::string tiny_dcf(const std::vector<std::pair<std::string, std::string>>& values) {
  std::string dcf = test::tiny_eds();
  for (const auto& [section, value] : values) {
    const std::string head = section + "\n";
    dcf.insert(dcf.find(head) + head.size(), "ParameterValue=" + value + "\n");
  }
  return dcf;
}

TEST(BootOfDcf, AValueOfADcfOutsideItsLimitsIsAWarningThatNamesItsLine) {
  std::string dcf = test::tiny_eds() + "[DeviceComissioning]\nNodeID=5\n";
  dcf.insert(dcf.find("[6081]\n") + 7, "ParameterValue=7\nHighLimit=5\n");

  const auto net = compile(arm(), dcf, "tiny.dcf");

  EXPECT_THAT(net.declared("limits"), HasSubstr("ParameterValue in line "));
  EXPECT_THAT(net.declared("limits"),
              HasSubstr("6081:00 Profile velocity = 7 is outside the limits ..5"));
}

TEST(BootOfDcf, ParameterValuesOfADcfAreWritten) {
  std::string eds = test::tiny_eds();
  const std::string section = "[6081]\n";
  eds.insert(eds.find(section) + section.size(), "ParameterValue=777\n");

  const auto net = compile(arm(), eds, "tiny.dcf");

  EXPECT_THAT(steps(net), testing::Contains("write if differs 6081:00 0x00000309"));
}

TEST(BootOfDcf, WhatFollowsFromTheNetworkFileIsNotWrittenOverByTheDcf) {
  const auto net = compile(
      "master: {sync_period: 10000, sync_window: 500}\n"
      "arm: {node_id: 5, dcf: x}\n",
      tiny_dcf({{"[1007]", "1000"}, {"[60C2sub1]", "77"}}), "tiny.dcf");

  const auto all = steps(net);
  EXPECT_THAT(all, testing::Contains("write if differs 1007:00 0x000001F4"));
  EXPECT_THAT(all, testing::Not(testing::Contains("write if differs 1007:00 0x000003E8")));
  EXPECT_THAT(all, testing::Contains("write if differs 60C2:01 0x0A"));
  EXPECT_THAT(all, testing::Not(testing::Contains("write if differs 60C2:01 0x4D")));
}

TEST(BootOfDcf, AnInterpolationPeriodOfTheNetworkFileIsReadWithTheExponentOfTheDcf) {
  const std::string yaml =
      "master: {sync_period: 2000}\n"
      "arm: {node_id: 5, dcf: x, sdo: [{index: 0x60C2, sub_index: 1, value: 20}]}\n";
  const auto net = compile(yaml, tiny_dcf({{"[60C2sub2]", "-4"}}), "tiny.dcf");

  EXPECT_THAT(net.declared("interpolation-period"), IsEmpty());
  EXPECT_THAT(steps(net), testing::Contains("write if differs 60C2:01 0x14"));
  EXPECT_THAT(steps(net), testing::Contains("write if differs 60C2:02 0xFC"));
}

TEST(BootOfDcf, WhatAnEdsCallsParameterValueIsNotTakenForConfigured) {
  const auto net = compile(arm(), tiny_dcf({{"[1016sub1]", "0x000300C8"}}), "tiny.eds");

  EXPECT_THAT(steps(net), testing::Contains("write if differs 1016:01 0x007F012C"));
}

TEST(BootOfDcf, AConsumerEntryOfADcfThatWatchesAnotherNodeStays) {
  const std::string dcf = tiny_dcf({{"[1016sub1]", "0x000300C8"}});
  const auto full = compile(arm(), dcf, "tiny.dcf");
  EXPECT_THAT(steps(full), testing::Contains("write if differs 1016:01 0x000300C8"));
  EXPECT_THAT(steps(full), testing::Not(testing::Contains(HasSubstr("0x007F012C"))));
  EXPECT_THAT(full.declared("heartbeat-consumer"), HasSubstr("all entries of 0x1016"));

  const auto room =
      compile(arm(), dcf + test::entry("1016sub2", "entry", 7, "rw", "0"), "tiny.dcf");
  EXPECT_THAT(steps(room), testing::Contains("write if differs 1016:02 0x007F012C"));
  EXPECT_THAT(room.declared("heartbeat-consumer"), IsEmpty());
}

TEST(BootOfDcf, APdoThatItSwitchesOffIsSwitchedOffInTheDevice) {
  const auto boot = [](const std::string& dcf) { return steps(compile(arm(), dcf, "t.dcf")); };
  const auto off = testing::Contains("disable PDO 1800:01");
  const std::string dcf =
      test::tiny_objects() + test::pdo(true, 1, "$NODEID+0x180", 1, {"0x60410010"});
  const std::string cob_id = "[1800sub1]\n";
  const std::size_t at = dcf.find(cob_id) + cob_id.size();
  const auto with = [&](const std::string& keys) {
    return dcf.substr(0, at) + keys + dcf.substr(at);
  };

  EXPECT_THAT(boot(with("ParameterValue=$NODEID+0x80000180\n")), off);
  EXPECT_THAT(boot(with("ParameterValue=$NODEID+0x80000180\nObjFlags=1\n")), testing::Not(off));
  EXPECT_THAT(steps(compile(arm(), with("ParameterValue=$NODEID+0x80000180\n"), "t.eds")),
              testing::Not(off));
}

TEST(BootOfDcf, APdoThatItOnlyCountsIsSwitchedOffInTheDevice) {
  std::string dcf = test::tiny_objects();
  dcf.insert(dcf.find("[DeviceInfo]\n") + 13, "CompactPDO=3\nNrOfTXPDO=5\n");

  const auto boot = steps(compile(arm(), dcf, "t.dcf"));

  EXPECT_EQ(std::ranges::count(boot, "compare 1800:01 0x80000000"), 1);
  EXPECT_EQ(std::ranges::count(boot, "compare 1803:01 0x80000000"), 1);
  EXPECT_EQ(std::ranges::count(boot, "compare 1804:01 0x80000000"), 0) << "off by default";
}

}  // namespace
}  // namespace takt
