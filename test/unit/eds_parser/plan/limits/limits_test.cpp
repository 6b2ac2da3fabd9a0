// The key `limits:` of a network file: the checks of the bus thread, and the cases that are refused
// with a reason.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/eds_parser/plan/limits/limited_drive.hpp"

namespace takt::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(Limits, OfAnAxisAreCheckedInCountsPerCycle) {
  const Compiled net = drive(
      "    limits: {position: [-1.5, 1.5], velocity: 2.0, acceleration: 20, jerk: 400, "
      "step: 0.01}\n");
  EXPECT_THAT(net.complaints(), IsEmpty());
  const OutputLimit& limit = only(net);
  EXPECT_EQ(net.plan.layout.signals[limit.signal].object, (ObjectKey{0x607A, 0}));
  EXPECT_EQ(limit.low, -1500.0);
  EXPECT_EQ(limit.high, 1500.0);
  EXPECT_DOUBLE_EQ(limit.step, 10.0);
  EXPECT_DOUBLE_EQ(limit.rate, 4.0);   // 2 rad/s x 2 ms / 1 mrad
  EXPECT_DOUBLE_EQ(limit.bend, 0.08);  // 20 rad/s^2 x (2 ms)^2 / 1 mrad
  EXPECT_TRUE(limit.wraps);
  ASSERT_TRUE(limit.feedback);
  EXPECT_EQ(net.plan.layout.signals[*limit.feedback].object, (ObjectKey{0x6064, 0}));
  ASSERT_TRUE(limit.statusword);
}

TEST(Limits, OfPositionTurnWithTheSignAndShiftWithTheOffset) {
  const Compiled net = drive("    limits: {position: [-1, 3]}\n", "{index: 0x607A}",
                             "    units: {position: {scale: 0.5, sign: -1, offset: 1, unit: m}}\n");
  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(only(net).low, -4.0);  // 3 m = -1 x -4 x 0.5 m + 1 m
  EXPECT_EQ(only(net).high, 4.0);
}

TEST(Limits, OfPositionNameThePositionOffsetBecauseTheSumIsChecked) {
  const std::string eds = tiny_eds() + entry("60B0", "Position offset", 4, "rww", "0", true);
  const Compiled net = compile(
      "master: {sync_period: 2000}\nnodes:\n  arm:\n    node_id: 5\n    dcf: tiny.eds\n"
      "    rpdo: {2: {enabled: true, mapping: [{index: 0x607A}, {index: 0x60B0}]}}\n"
      "    units: {position: {scale: 0.001, unit: rad}}\n"
      "    limits: {position: [-1, 1]}\n",
      eds);
  EXPECT_THAT(net.complaints(), IsEmpty());
  ASSERT_FALSE(net.plan.limits.lines.empty());
  EXPECT_EQ(net.plan.limits.lines[0].kind, LimitKind::position);
  EXPECT_EQ(net.plan.limits.lines[0].signals.size(), 2U);
}

TEST(Limits, CountNoStepWhereTheFileSetsAModeWithoutSetPoints) {
  for (const auto& [mode, number] : {std::pair{"3", 3}, {"8", 8}}) {
    const Compiled net = drive(
        "    limits: {step: 0.01}\n    sdo: [{index: 0x6060, value: " + std::string{mode} + "}]\n");
    EXPECT_EQ(only(net).fixed_mode, number);
  }
}

TEST(Limits, OfVelocityBoundTheTargetVelocityAndItsChange) {
  const Compiled net = drive("    limits: {velocity: 2.0, acceleration: 20}\n", "{index: 0x60FF}");
  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(only(net).low, -200.0);
  EXPECT_EQ(only(net).high, 200.0);
  EXPECT_EQ(only(net).range, LimitKind::velocity);
  EXPECT_DOUBLE_EQ(only(net).rate, 4.0);  // 20 rad/s^2 x 2 ms / 0.01 rad/s
  EXPECT_EQ(only(net).rate_of, LimitKind::acceleration);
  EXPECT_FALSE(only(net).wraps);
}

TEST(Limits, OfVelocityAndAccelerationBoundThoseOfAProfileInTheirOwnUnits) {
  for (const int index : {0x6081, 0x6083, 0x6084}) {
    const Compiled net = compile(
        "master: {sync_period: 2000}\nnodes:\n  arm:\n    node_id: 5\n    dcf: tiny.eds\n"
        "    rpdo: {2: {enabled: true, mapping: [{index: 0x607A}, {index: " +
            std::to_string(index) + "}]}}\n" + std::string{units} +
            "    limits: {velocity: 2.0, acceleration: 20}\n",
        tiny_eds() + entry("6083", "Profile acceleration", 7, "rw", "1", true) +
            entry("6084", "Profile deceleration", 7, "rw", "1", true));
    EXPECT_THAT(net.complaints(), IsEmpty());
    ASSERT_EQ(net.plan.limits.outputs.size(), 2U);
    const OutputLimit& limit = net.plan.limits.outputs[1];
    EXPECT_EQ(limit.high, 200.0);  // 2 rad/s / 0.01 rad/s, and 20 rad/s^2 / 0.1 rad/s^2
    EXPECT_EQ(limit.range, index == 0x6081 ? LimitKind::velocity : LimitKind::acceleration);
    EXPECT_EQ(limit.rate, OutputLimit::none);
  }
}

TEST(Limits, OfATargetVelocityStartAtTheActualOne) {
  const Compiled net = compile(
      "master: {sync_period: 2000}\nnodes:\n  arm:\n    node_id: 5\n    dcf: tiny.eds\n"
      "    tpdo: {1: {mapping: [{index: 0x6041}, {index: 0x606C}]}}\n"
      "    rpdo: {2: {enabled: true, cob_id: auto, mapping: [{index: 0x60FF}]}}\n" +
          std::string{units} + "    limits: {acceleration: 20}\n",
      tiny_eds());
  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(only(net).feedback, net.plan.layout.find(0, {0x606C, 0}, false));
}

TEST(Limits, OfASecondAxisMayDiffer) {
  const std::string eds = tiny_eds() + entry("687A", "Target position", 4, "rww", "0", true);
  const Compiled net = compile(
      "master: {sync_period: 2000}\nnodes:\n  arm:\n    node_id: 5\n    dcf: tiny.eds\n"
      "    rpdo: {2: {enabled: true, mapping: [{index: 0x607A}, {index: 0x687A}]}}\n"
      "    units: {position: {scale: 0.001, unit: rad}}\n"
      "    limits: {step: 0.01, position: [-1, 1], axes: {2: {position: [-2, 2]}}}\n",
      eds);
  EXPECT_THAT(net.complaints(), IsEmpty());
  ASSERT_EQ(net.plan.limits.outputs.size(), 2U);
  EXPECT_EQ(net.plan.limits.outputs[0].high, 1000.0);
  EXPECT_EQ(net.plan.limits.outputs[1].high, 2000.0);
  EXPECT_DOUBLE_EQ(net.plan.limits.outputs[1].step, 10.0);
}

TEST(Limits, OfASingleOutputAreInItsUnit) {
  const Compiled net = drive(
      "      objects: [{index: 0x2003, scale: 0.1, unit: V}]\n"
      "    limits: {objects: [{index: 0x2003, min: 0, max: 10, step: 0.5}]}\n",
      "{index: 0x2003}");
  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_EQ(only(net).low, 0.0);
  EXPECT_EQ(only(net).high, 100.0);
  EXPECT_DOUBLE_EQ(only(net).step, 5.0);
  EXPECT_EQ(only(net).range, LimitKind::range);
  EXPECT_EQ(net.plan.limits.outputs[0].rate, OutputLimit::none);
}

TEST(Limits, OfASingleOutputAreProposed) {
  EXPECT_THAT(text_of(drive("", "{index: 0x2003}")),
              HasSubstr("arm 2003:00  range         none  proposal: `objects: [{index: 0x2003, "
                        "min: ..., max: ...}]` (if it is a number, enter what the machine "
                        "permits; a bit field needs no limits)\n"));
  std::string eds = tiny_eds();
  const std::size_t wide = eds.find("[2003]\n") + 7;
  eds.insert(wide, "LowLimit=10\nHighLimit=500\n");
  EXPECT_THAT(text_of(drive("      objects: [{index: 0x2003, scale: 0.1, unit: V}]\n",
                            "{index: 0x2003}", units, eds)),
              HasSubstr("proposal: `objects: [{index: 0x2003, min: 1, max: 50}]` (LowLimit and "
                        "HighLimit of the device file)\n"));
  eds.replace(eds.find("LowLimit=10\nHighLimit=500"), 25, "LowLimit=0\nHighLimit=0xFFFFFFFF");
  EXPECT_THAT(text_of(drive("", "{index: 0x2003}", units, eds)), HasSubstr("min: ..., max: ...}"));
}

TEST(Limits, OfASingleOutputAreNotProposedAgain) {
  EXPECT_THAT(
      text_of(drive("    limits: {objects: [{index: 0x2003, max: 10}]}\n", "{index: 0x2003}")),
      Not(HasSubstr("proposal: `objects")));
  EXPECT_THAT(text_of(drive("")), Not(HasSubstr("proposal: `objects")))
      << "the controlword and the set-points of a drive";
}

TEST(Limits, OfControlWordsAndBitFieldsAreNotProposed) {
  for (const std::string name : {"Control word", "PDO2 ControlWord 1", "Bit field of valves"}) {
    std::string eds = tiny_eds();
    const std::size_t at = eds.find("ParameterName=", eds.find("[2003]\n")) + 14;
    eds.replace(at, eds.find('\n', at) - at, name);
    EXPECT_THAT(text_of(drive("", "{index: 0x2003}", units, eds)), Not(HasSubstr("2003:00  range")))
        << name;
  }
}

TEST(Limits, AreAbsentWhereNobodyGivesThem) {
  EXPECT_THAT(drive("").plan.limits.outputs, IsEmpty());
}

TEST(Limits, ThatMakeNoSenseAreErrorsWhereTheyStand) {
  EXPECT_THAT(drive("    limits: {position: [2, 1]}\n").complaints(),
              ElementsAre("12:24 error [out-of-range]"));
  EXPECT_THAT(drive("    limits: {position: 1}\n").complaints(),
              ElementsAre("12:24 error [wrong-type]"));
  EXPECT_THAT(drive("    limits: {velocity: -1}\n").complaints(),
              ElementsAre("12:24 error [out-of-range]"));
  EXPECT_THAT(drive("    limits: {step: 0}\n").complaints(),
              ElementsAre("12:20 error [out-of-range]"));
  EXPECT_THAT(drive("    limits: {step: .inf}\n").complaints(), Not(IsEmpty()));
  EXPECT_THAT(drive("    limits: {position: [.nan, 1]}\n").complaints(), Not(IsEmpty()));
  EXPECT_THAT(drive("    limits: {speed: 1}\n").complaints(),
              ElementsAre("12:14 error [unknown-key]"));
  EXPECT_THAT(drive("    limits: {axes: {9: {step: 1}}}\n").complaints(),
              ElementsAre("12:21 error [out-of-range]"));
  EXPECT_THAT(drive("    limits: {axes: {2: {step: 1}}}\n").declared("limits"),
              HasSubstr("carries a set-point of axis 2"));
  EXPECT_THAT(drive("    limits: {objects: [{index: 0x2003, min: 2, max: 1}]}\n").complaints(),
              ElementsAre("12:45 error [out-of-range]"));
  EXPECT_THAT(drive("    limits: {objects: [{index: 0x2003}]}\n").complaints(),
              ElementsAre("12:24 error [missing-key]"));
  EXPECT_THAT(drive("    limits: {objects: [{index: 0x2003, max: 1}, {index: 0x2003, max: 2}]}\n")
                  .complaints(),
              testing::Contains("12:49 error [written-twice]"));
}

TEST(Limits, OfWhatIsNotCommandedAreErrors) {
  EXPECT_THAT(drive("    limits: {objects: [{index: 0x2003, max: 1}]}\n").declared("limits"),
              HasSubstr("no RPDO carries 2003:00"));
  EXPECT_THAT(drive("    limits: {step: 1}\n", "{index: 0x2003}").declared("limits"),
              HasSubstr("no RPDO of node `arm` carries a set-point of a drive"));
}

TEST(Limits, WithoutAUnitAreErrors) {
  const Compiled net = drive("    limits: {position: [-1, 1]}\n", "{index: 0x607A}", "");
  EXPECT_THAT(net.complaints(), ElementsAre("8:24 error [limits]"));
  EXPECT_THAT(net.declared("limits"), HasSubstr("has no unit"));
}

TEST(Limits, InAnotherUnitThanPositionsAreReportedAndNotCompared) {
  const Compiled net =
      drive("    limits: {velocity: 3000}\n", "{index: 0x607A}",
            "    units: {position: {scale: 0.001, unit: rad}, velocity: {scale: 1, unit: rpm}}\n");
  EXPECT_THAT(net.complaints(), ElementsAre("9:24 warning [limits]"));
  EXPECT_THAT(net.plan.limits.outputs, IsEmpty());
}

TEST(Limits, ThatAFallbackOrASafeValueBreaksAreErrors) {
  EXPECT_THAT(drive("      objects: [{index: 0x2003, unit: V}]\n"
                    "    safe_values: [{index: 0x2003, value: 20}]\n"
                    "    limits: {objects: [{index: 0x2003, min: 1, max: 10}]}\n",
                    "{index: 0x2003}")
                  .declared("limits"),
              HasSubstr("lies outside its limits"));
}

TEST(Limits, AreNamedWithTheirSourceByThePlan) {
  const Compiled net = drive("    limits: {position: [-1.5, 1.5], velocity: 2, jerk: 400}\n");
  EXPECT_THAT(text_of(net),
              AllOf(HasSubstr("arm  position      -1.5 .. 1.5 rad  from the network file\n"),
                    HasSubstr("arm  velocity      2 rad/s          from the network file\n"),
                    HasSubstr("arm  jerk          400 rad/s^3      from the network file, used for "
                              "planned motion only\n"),
                    HasSubstr("arm  step          none             proposal: `step: 0.004` "
                              "(velocity in one cycle)\n")));
  EXPECT_THAT(json_of(net), HasSubstr(R"("source": "file")"));
}

TEST(Limits, OfTheFollowingErrorAreForMotionsOnly) {
  const Compiled net = drive("    limits: {position: [-1.5, 1.5], following_error: 0.1}\n");
  EXPECT_THAT(net.complaints(), IsEmpty());
  EXPECT_THAT(text_of(net),
              HasSubstr("arm  following_error  0.1 rad          from the network file, used for "
                        "planned motion only\n"));
  EXPECT_THAT(json_of(net), HasSubstr(R"("limit": "following_error")"));
}

TEST(Limits, AreProposedWhereThereAreNone) {
  const Compiled net = drive("    limits: {velocity: 2}\n");
  EXPECT_THAT(text_of(net),
              AllOf(HasSubstr("proposal: `position: ...` (enter the travel of the machine"),
                    HasSubstr("proposal: `step: 0.004` (velocity in one cycle)")));
  EXPECT_THAT(text_of(drive("")), HasSubstr("proposal: `velocity: 10` (6081:00)"));
}

TEST(Limits, OfARotaryAxisThatMayNotTurnOverThereAreAWarning) {
  const std::string range_limit =
      record("607B", "Position range limit", 3) + entry("607Bsub0", "highest", 5, "const", "2") +
      entry("607Bsub1", "min", 4, "rw", "0") + entry("607Bsub2", "max", 4, "rw", "0");
  const auto rotary = [&](const std::string& written, const std::string& objects) {
    std::string text;
    for (const Finding& f : drive("    limits: {modulo: 3.6, step: 0.01}\n" + written,
                                  "{index: 0x607A}", units, tiny_eds() + objects)
                                .findings) {
      if (f.rule == "limits") text += std::string{name(f.severity)} + ": " + f.message + "\n";
    }
    return text;
  };
  EXPECT_THAT(rotary("", range_limit),
              AllOf(HasSubstr("warning: `modulo` of node `arm` is 3600 counts of"),
                    HasSubstr("nothing sets 607B:00 (position range limit)"),
                    HasSubstr("Write 607B:01 and 607B:02 under `sdo:`")));
  EXPECT_THAT(rotary("    sdo: [{index: 0x607B, sub_index: 2, value: 9999}]\n", range_limit),
              HasSubstr("but 607B:00 (position range limit) wraps after 10000"));
  EXPECT_EQ(rotary("    sdo: [{index: 0x607B, sub_index: 2, value: 3599}]\n", range_limit), "");
  EXPECT_EQ(rotary("    sdo: [{index: 0x607B, sub_index: 2, value: 3600}]\n", range_limit), "")
      << "a rounded number";
  EXPECT_THAT(rotary("", ""), AllOf(HasSubstr("note: "), HasSubstr("does not have this object")));
}

/// Motions need the turn of a rotary axis, even if the output has no other limit.
TEST(Limits, ATurnBeginsWhereThatOfTheDriveBegins) {
  const std::string range_limit =
      record("607B", "Position range limit", 3) + entry("607Bsub0", "highest", 5, "const", "2") +
      entry("607Bsub1", "min", 4, "rw", "0") + entry("607Bsub2", "max", 4, "rw", "0");
  const auto row = [&](const std::string& keys) {
    return only(drive(keys, "{index: 0x607A}", units, tiny_eds() + range_limit));
  };
  const std::string of_drive =
      "    sdo: [{index: 0x607B, sub_index: 1, value: -1800}, {index: 0x607B, sub_index: 2, "
      "value: 1799}]\n";
  EXPECT_EQ(row(of_drive).modulus, 3600.0);
  EXPECT_EQ(row(of_drive).lowest, -1800.0);
  EXPECT_EQ(row("    limits: {modulo: 3.6}\n" + of_drive).lowest, -1800.0);
  EXPECT_EQ(row("    limits: {modulo: 3.6}\n").lowest, 0.0);
  EXPECT_EQ(row("    limits: {modulo: 3.6, position: [-1.2, 2.4]}\n").lowest, -1200.0);
  EXPECT_EQ(row("    limits: {modulo: 4294967.296}\n").lowest, -0x1p31);
}

TEST(Limits, OfTheFollowingErrorCanDifferForAnAxis) {
  const Compiled net =
      drive("    limits: {step: 1, following_error: 0.1, axes: {1: {following_error: 0.2}}}\n");
  EXPECT_THAT(text_of(net), HasSubstr("0.2 rad"));
}

/// Compiles a limited axis whose actual position comes in TPDO2 with these keys.
std::string start_of(const std::string& tpdo, const std::string& limits) {
  const Compiled net = compile(
      "master: {sync_period: 2000}\nnodes:\n  arm:\n    node_id: 5\n    dcf: tiny.eds\n"
      "    tpdo: {2: {enabled: true, cob_id: auto, " +
      tpdo +
      "}}\n"
      "    rpdo: {2: {enabled: true, cob_id: auto, mapping: [{index: 0x6040}, {index: "
      "0x607A}]}}\n" +
      std::string{units} + "    limits: {" + limits + "}\n");
  return net.declared("limits");
}

TEST(Limits, ThatWaitForAPositionThatComesByEventAloneHaveAWarning) {
  for (const char* const limits : {"step: 0.01", "velocity: 2.0", "acceleration: 20"}) {
    EXPECT_THAT(
        start_of("transmission: 255", limits),
        AllOf(HasSubstr(
                  "limits of node `arm` hold its set-points back until 6064:00 has arrived once"),
              HasSubstr("TPDO2 sends it only by event (transmission 255 without "
                        "`event_timer`)"),
              HasSubstr("Give TPDO2 an `event_timer`, or make it synchronous")));
  }
  EXPECT_THAT(start_of("transmission: 254", "step: 0.01"), HasSubstr("(transmission 254 without"));
  EXPECT_EQ(start_of("transmission: 255, event_timer: 100", "step: 0.01"), "");
  EXPECT_EQ(start_of("transmission: 1", "step: 0.01"), "");
  EXPECT_EQ(start_of("transmission: 255", "position: [-1, 1]"), "") << "a range needs no start";
}

TEST(Limits, OfARoundedTurnCountTheTurnOfTheDrive) {
  const std::string range_limit =
      record("607B", "Position range limit", 3) + entry("607Bsub0", "highest", 5, "const", "2") +
      entry("607Bsub1", "min", 4, "rw", "0") + entry("607Bsub2", "max", 4, "rw", "35999");
  const Compiled net = drive("    limits: {modulo: 35.999, step: 0.01}\n", "{index: 0x607A}", units,
                             tiny_eds() + range_limit);
  EXPECT_EQ(only(net).modulus, 36'000.0) << "35999 would make a way of 35999 no turn-over";
}

}  // namespace
}  // namespace takt::test
