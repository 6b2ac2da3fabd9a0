#include "eds_parser/plan/boot/boot_compiler.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eds_parser/print/plan/plan_names.hpp"
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

TEST(BootCompiler, TextInQuotesIsTextForAStringAndANumberForTheRest) {
  const std::string eds =
      test::tiny_eds() + "[2008]\nParameterName=Label\nDataType=9\nAccessType=rw\n";

  const auto net =
      compile(arm("sdo: [{index: 0x2008, value: \"12\"}, {index: 0x6081, value: '0x10'}]"), eds);
  const auto wrong = compile(arm("sdo: [{index: 0x6081, value: \"1.2.3\"}]"), eds);
  const auto plain = compile(arm("sdo: [{index: 0x2008, value: 12}]"), eds);

  EXPECT_THAT(
      part(net, "write if differs 2008:00 0x3231", 2),
      ElementsAre("write if differs 2008:00 0x3231", "write if differs 6081:00 0x00000010"));
  EXPECT_THAT(
      net.declared("quoted-number"),
      HasSubstr("6081:00 Profile velocity (UNSIGNED32) gets the number in the quotes, 0x10"));
  EXPECT_THAT(wrong.declared("out-of-range"), HasSubstr("takes a number"));
  EXPECT_THAT(plain.declared("out-of-range"), HasSubstr("takes text in quotes"));
}

TEST(BootCompiler, ANumberThatARealCannotHoldIsAnError) {
  const std::string eds =
      test::tiny_eds() + "[2008]\nParameterName=Gain\nDataType=8\nAccessType=rw\n";

  const auto net = compile(arm("sdo: [{index: 0x2008, value: 3.4e38}]"), eds);
  const auto wrong = compile(arm("sdo: [{index: 0x2008, value: -1.0e+39}]"), eds);

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_THAT(wrong.declared("out-of-range"),
              HasSubstr("2008:00 Gain (REAL32) holds at most 3.4e38"));
}

TEST(BootCompiler, WholeBootOfATinyDriveInOrder) {
  const auto net = compile(arm("sdo: [{index: 0x6081, value: 1000}]"));

  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_THAT(
      steps(net),
      ElementsAre(
          "NMT", "await boot-up", "probe 1000:00", "expect 1000:00 0x00020192",
          "expect 1018:01 0x0000ABCD", "expect 1018:02 0x00000402",
          "write if differs 1017:00 0x0064", "write if differs 1016:01 0x007F012C",
          "write if differs 1005:00 0x00000080", "compare 1019:00 0x00", "skip if same",
          "write 1006:00 0x00000000", "write 1019:00 0x00", "write if differs 1006:00 0x00002710",
          "write if differs 60C2:01 0x0A", "write if differs 60C2:02 0xFD",
          "write if differs 6081:00 0x000003E8", "compare 1600:00 0x01",
          "compare 1600:01 0x60400010", "skip if same", "disable PDO 1400:01", "write 1600:00 0x00",
          "write 1600:01 0x60400010", "write 1600:00 0x01", "compare 1400:01 0x00000205",
          "compare 1400:02 0x01", "compare 1400:05 0x0000", "skip if same", "disable PDO 1400:01",
          "write if differs 1400:02 0x01", "write if differs 1400:05 0x0000",
          "enable PDO 1400:01 0x00000205", "verify 1400:01 0x00000205", "verify 1600:00 0x01",
          "verify 1600:01 0x60400010", "compare 1A00:00 0x01", "compare 1A00:01 0x60410010",
          "skip if same", "disable PDO 1800:01", "write 1A00:00 0x00", "write 1A00:01 0x60410010",
          "write 1A00:00 0x01", "compare 1800:01 0x00000185", "compare 1800:02 0x01",
          "compare 1800:03 0x0000", "compare 1800:05 0x0000", "compare 1800:06 0x00",
          "skip if same", "disable PDO 1800:01", "write if differs 1800:02 0x01",
          "write if differs 1800:03 0x0000", "write if differs 1800:05 0x0000",
          "write if differs 1800:06 0x00", "enable PDO 1800:01 0x00000185",
          "verify 1800:01 0x00000185", "verify 1A00:00 0x01", "verify 1A00:01 0x60410010",
          "await heartbeat", "NMT", "await OPERATIONAL"));
}

TEST(BootCompiler, SkipsLandBehindTheirGroup) {
  const auto net = compile(arm());

  const auto& all = net.plan.nodes[0].boot_plan.steps;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].action != BootAction::skip_if_same) continue;
    ASSERT_LE(all[i].target, all.size());
    const BootAction last = all[all[i].target - 1U].action;
    EXPECT_TRUE(last == BootAction::verify || last == BootAction::write) << i;
  }
}

TEST(BootCompiler, LettersAreThoseOfCia302) {
  const auto net = compile(arm("revision_number: 3, serial_number: 4"));

  EXPECT_EQ(step_at(net, "probe 1000:00").letter, 'B');
  EXPECT_EQ(step_at(net, "expect 1000:00 0x00020192").letter, 'C');
  EXPECT_EQ(step_at(net, "expect 1018:01 0x0000ABCD").letter, 'D');
  EXPECT_EQ(step_at(net, "expect 1018:02 0x00000402").letter, 'M');
  EXPECT_EQ(step_at(net, "expect 1018:03 0x00000003").letter, 'N');
  EXPECT_EQ(step_at(net, "expect 1018:04 0x00000004").letter, 'O');
  EXPECT_EQ(step_at(net, "write if differs 1017:00 0x0064").letter, 'J');
  EXPECT_EQ(step_at(net, "await heartbeat").letter, 'K');
}

TEST(BootCompiler, EveryStepHasAPurposeAndEveryWaitALimit) {
  const auto net = compile(arm("tpdo: {2: {enabled: false}}, restore_configuration: 0"));

  for (const BootStep& step : net.plan.nodes[0].boot_plan.steps) {
    EXPECT_FALSE(step.purpose.empty());
    const bool no_wait = step.action == BootAction::nmt || step.action == BootAction::skip_if_same;
    EXPECT_EQ(step.timeout == Time{}, no_wait) << step.purpose;
  }
}

TEST(BootCompiler, ExpectedIdentityOfTheNetworkFileWinsAndZeroSwitchesOff) {
  const auto net = compile(arm("device_type: 0, vendor_id: 0x42, product_code: 0"));

  EXPECT_THAT(
      part(net, "probe 1000:00", 3),
      ElementsAre("probe 1000:00", "expect 1018:01 0x00000042", "write if differs 1017:00 0x0064"));
}

TEST(BootCompiler, AnIdentityThatTheEdsDoesNotHaveIsNotAskedFor) {
  const std::string eds = "[DeviceInfo]\nVendorNumber=0x55\nProductNumber=0x66\n" +
                          test::entry("1000", "Device type", 7, "ro", "0") +
                          test::record("1018", "Identity", 2) +
                          test::entry("1018sub0", "n", 5, "const", "1") +
                          test::entry("1018sub1", "Vendor", 7, "ro", "0x55");

  const auto net = compile("arm: {node_id: 5, dcf: x}\n", eds);

  EXPECT_THAT(steps(net), ElementsAre("NMT", "await boot-up", "probe 1000:00",
                                      "expect 1018:01 0x00000055", "NMT"));
}

TEST(BootCompiler, LimitsOfTheEdsKeepPlannedValuesOutWithAWarning) {
  std::string eds = test::tiny_eds();
  for (const std::string section : {"[1006]\n", "[1016sub1]\n"}) {
    eds.insert(eds.find(section) + section.size(), "HighLimit=9999\n");
  }

  const auto net = compile(arm(), eds);

  EXPECT_THAT(net.complaints(), ElementsAre("2:1 warning [limits]", "2:1 warning [limits]"));
  EXPECT_THAT(steps(net), testing::Not(testing::Contains(HasSubstr("differs 1016:01"))));
  EXPECT_THAT(steps(net), testing::Not(testing::Contains(HasSubstr("differs 1006:00"))));
}

TEST(BootCompiler, AValueOutsideTheLimitsOfTheEdsIsAWarningAndAWordInThePlan) {
  std::string eds = test::tiny_eds();
  for (const std::string section : {"[1800sub2]\n", "[6081]\n"}) {
    eds.insert(eds.find(section) + section.size(), "LowLimit=2\nHighLimit=240\n");
  }
  eds.insert(eds.find("[1017]\n") + 7, "LowLimit=0\nHighLimit=0\n");  // from an EDS editor

  const auto net =
      compile(arm("sdo: [{index: 0x6081, value: 500}], tpdo: {1: {transmission: 254}}"), eds);

  EXPECT_THAT(net.complaints(), ElementsAre("2:56 warning [limits]", "2:70 warning [limits]"));
  EXPECT_THAT(net.declared("limits"),
              HasSubstr("`sdo` of node `arm`: 6081:00 Profile velocity = 500 is "
                        "outside the limits 2..240 of tiny.eds"));
  EXPECT_THAT(net.declared("limits"), HasSubstr("1800:02 type = 254 is outside the limits 2..240"));
  EXPECT_THAT(step_at(net, "write if differs 6081:00 0x000001F4").purpose,
              HasSubstr("outside the limits 2..240 of the device file"));
}

TEST(BootCompiler, ResetPoliciesAreHonoured) {
  EXPECT_EQ(compile(arm()).plan.nodes[0].boot_plan.steps[0].command,
            NmtCommand::reset_communication);
  EXPECT_EQ(compile(arm("reset: node")).plan.nodes[0].boot_plan.steps[0].command,
            NmtCommand::reset_node);
  EXPECT_EQ(steps(compile(arm("reset: none")))[0], "probe 1000:00");
  EXPECT_EQ(steps(compile(arm("reset_communication: false")))[0], "await life");
  EXPECT_THAT(compile(arm("reset: none, reset_communication: true")).declared("duplicate-key"),
              HasSubstr("keep one"));
}

TEST(BootCompiler, ANodeThatIsNotBootedHasNoSteps) {
  EXPECT_THAT(steps(compile(arm("boot: false"))), IsEmpty());
}

TEST(BootCompiler, RestoringWritesLoadAndResets) {
  const std::string eds = test::tiny_eds() + test::record("1011", "Restore", 3) +
                          test::entry("1011sub0", "n", 5, "const", "2") +
                          test::entry("1011sub1", "all", 7, "rw", "1") +
                          test::entry("1011sub2", "communication", 7, "rw", "1");

  const auto net = compile(arm("restore_configuration: 2"), eds);

  EXPECT_THAT(part(net, "write 1011:02 0x64616F6C", 4),
              ElementsAre("write 1011:02 0x64616F6C", "NMT", "await boot-up", "probe 1000:00"));
  EXPECT_THAT(compile(arm("restore_configuration: 1")).declared("no-such-object"),
              HasSubstr("1011:01"));
}

TEST(BootCompiler, TheHeartbeatOfTheMasterIsOptional) {
  const auto off =
      compile("master: {sync_period: 10000, heartbeat_producer: 0}\narm: {node_id: 5, dcf: x}\n");
  EXPECT_THAT(steps(off), testing::Not(testing::Contains(HasSubstr("1016:01"))));

  const auto deaf = compile(arm("heartbeat_consumer: false"));
  EXPECT_THAT(steps(deaf), testing::Not(testing::Contains(HasSubstr("1016:01"))));

  const auto slow = compile(
      "options: {heartbeat_multiplier: 2}\nmaster: {node_id: 1, heartbeat_producer: 500}\n"
      "arm: {node_id: 5, dcf: x, heartbeat_producer: 200}\n");
  EXPECT_THAT(steps(slow), testing::Contains("write if differs 1016:01 0x000103E8"));
  EXPECT_EQ(slow.plan.nodes[0].heartbeat_timeout, std::chrono::milliseconds{400});
}

TEST(BootCompiler, APdoThatIsSwitchedOffIsSwitchedOffInTheDevice) {
  const auto net = compile(arm("tpdo: {1: {enabled: false}}"));

  EXPECT_THAT(part(net, "compare 1800:01 0x80000000", 3),
              ElementsAre("compare 1800:01 0x80000000", "skip if same", "disable PDO 1800:01"));
  EXPECT_EQ(step_at(net, "compare 1800:01 0x80000000").mask, 0x80000000U);
  EXPECT_TRUE(net.plan.pdos.tpdos.empty());
}

TEST(BootCompiler, AFixedMappingIsComparedButNotWritten) {
  const std::string eds =
      test::tiny_objects() + test::pdo(true, 1, "$NODEID+0x180", 1, {"0x60410010"}, "const");

  const auto net = compile(arm(), eds);

  EXPECT_THAT(steps(net), testing::Contains("verify 1A00:01 0x60410010"));
  EXPECT_THAT(steps(net), testing::Not(testing::Contains(testing::StartsWith("write 1A00"))));
}

TEST(BootCompiler, TheCounterNeedsThePeriodToBeZeroFirst) {
  const auto net = compile(
      "master: {sync_period: 10000, sync_overflow: 10, sync_window: 8000}\n"
      "arm: {node_id: 5, dcf: x}\n");

  EXPECT_THAT(part(net, "compare 1019:00 0x0A", 6),
              ElementsAre("compare 1019:00 0x0A", "skip if same", "write 1006:00 0x00000000",
                          "write 1019:00 0x0A", "write if differs 1006:00 0x00002710",
                          "write if differs 1007:00 0x00001F40"));
}

TEST(BootCompiler, InterpolationPeriodsAreExactOrWarnedOf) {
  const auto fine = compile("master: {sync_period: 250}\narm: {node_id: 5, dcf: x}\n");
  EXPECT_THAT(steps(fine), testing::Contains("write if differs 60C2:01 0x19"));
  EXPECT_THAT(steps(fine), testing::Contains("write if differs 60C2:02 0xFB"));

  const auto odd = compile("master: {sync_period: 3001}\narm: {node_id: 5, dcf: x}\n");
  EXPECT_THAT(odd.declared("interpolation-period"), HasSubstr("can't express"));

  const auto own = compile(arm("sdo: [{index: 0x60C2, sub_index: 1, value: 50}]"));
  EXPECT_THAT(own.declared("interpolation-period"), HasSubstr("sets 50000 us"));
}

TEST(BootCompiler, ValuesOfSdoAreCheckedAgainstTheEds) {
  const auto net = compile(
      "master: {sync_period: 10000}\n"
      "arm:\n"
      "  node_id: 5\n"
      "  dcf: x\n"
      "  sdo:\n"
      "    - {index: 0x6060, value: 200}\n"
      "    - {index: 0x6040, value: 65536}\n"
      "    - {index: 0x6041, value: 1}\n"
      "    - {index: 0x6099, value: 1}\n"
      "    - {index: 0x1018, sub_index: 9, value: 1}\n"
      "    - {index: 0x2002, value: 5}\n"
      "    - {index: 0x6064, value: 1.5}\n"
      "    - {index: 0x607A, value: 1.5}\n"
      "    - {index: 0x6061, value: fast}\n");

  EXPECT_THAT(net.complaints(),
              ElementsAre("7:30 error [out-of-range]", "8:7 error [read-only]",
                          "9:7 error [no-such-object]", "10:7 error [no-such-object]",
                          "11:30 error [out-of-range]", "12:7 error [read-only]",
                          "13:30 error [out-of-range]", "14:7 error [read-only]"));
}

TEST(BootCompiler, StartNodesFalseLeavesNodesPreOperational) {
  const auto net = compile("master: {start_nodes: false}\narm: {node_id: 5, dcf: x}\n");

  EXPECT_EQ(steps(net).back(), "await heartbeat");
}

TEST(BootCompiler, AConsumerEntryOfTheNetworkFileStays) {
  const auto net = compile(arm("sdo: [{index: 0x1016, sub_index: 1, value: 0x0005012C}]"),
                           test::tiny_eds() + test::entry("1016sub2", "entry", 7, "rw", "0"));

  EXPECT_THAT(steps(net), testing::Contains("write if differs 1016:01 0x0005012C"));
  EXPECT_THAT(steps(net), testing::Contains("write if differs 1016:02 0x007F012C"));
}

// The DCFs of Sevcon have such limits, which would refuse bit 31.
TEST(BootCompiler, EmcyIsNotSwitchedOffWhereTheLimitsForbidIt) {
  const auto after_skip = [](const std::string& limits) {
    const std::string eds = test::tiny_eds() + test::entry("1014", "EMCY", 7, "rw", "0") + limits;
    const auto all = part(compile(arm("emcy_cob_id: 0x85"), eds), "compare 1014:00 0x00000085", 4);
    return std::vector(all.begin() + 2, all.end());
  };

  EXPECT_THAT(after_skip("HighLimit=0xFFFFFFFF\n"),
              ElementsAre("disable PDO 1014:00", "enable PDO 1014:00 0x00000085"));
  EXPECT_THAT(after_skip("HighLimit=0x1FFFFFFF\n").front(), "enable PDO 1014:00 0x00000085");
}

TEST(BootCompiler, AnEmcyIdOfAnEdsCountsOnlyWhereItIsRelative) {
  const auto emcy = [](const std::string& text) {
    return compile(arm(), test::tiny_eds() + test::entry("1014", "EMCY", 7, "rw", text))
        .plan.nodes[0]
        .emcy_cob_id;
  };

  EXPECT_EQ(emcy("166"), std::nullopt);
  EXPECT_EQ(emcy("$NODEID+0x90"), CobId::base(0x95));
  EXPECT_EQ(emcy("$NODEID+0x80"), std::nullopt);
}

}  // namespace
}  // namespace takt
