// The questions of a careful colleague about a network file that can be run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <utility>

#include "eds_parser/network_file/load_network.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* drive = "dcf: " TAKT_SOURCE_DIR "/share/eds/takt_drive402.eds";
constexpr const char* no_other_pdos =
    "2: {enabled: false}, 3: {enabled: false}, 4: {enabled: false}";

class Careful : public testing::Test {
 protected:
  std::string reported_of(const std::string& text) {
    std::string reported;
    LoadedNetwork network = load_network(folder_.write("net.yaml", text));
    for (Finding finding : network.findings) {
      finding.file = "net.yaml";
      reported += to_string(finding) + "\n";
    }
    plan_ = std::move(network.plan);
    return reported;
  }
  /// Returns the messages for one drive with these additional keys.
  std::string of_drive(const std::string& keys, const std::string& bus = "") {
    return reported_of("bus: {name: lift" + bus +
                       "}\nmaster: {sync_period: 10000}\nnodes:\n  a: {" + drive +
                       ", node_id: 1, " + keys + "}\n");
  }
  static std::string rpdo1(const std::string& mapping) {
    return "rpdo: {1: {transmission: 1, mapping: " + mapping + "}, " + no_other_pdos + "}";
  }
  static std::string tpdo1(const std::string& keys) {
    return "tpdo: {1: {" + keys + "}, " + no_other_pdos + "}";
  }
  Time deadline_of_first() const {
    return plan_.pdos.tpdos.empty() ? Time{} : plan_.pdos.tpdos[0].deadline;
  }

  const test::Folder folder_;
  BusPlan plan_;
};

// modes

TEST_F(Careful, AnAxisWhoseModeNobodySetsIsAWarningWithTheMend) {
  EXPECT_THAT(of_drive(rpdo1("[0x6040, 0x607A]")),
              AllOf(HasSubstr("warning: RPDO1 of node `a` carries 607A:00, but nothing sets the "
                              "mode of operation, 6060:00"),
                    HasSubstr("Map 0x6060 into an RPDO, or write `sdo: [{index: 0x6060, value: "
                              "8}]`"),
                    HasSubstr("[mode]")));
}

TEST_F(Careful, AModeThatIsMappedOrWrittenIsNone) {
  EXPECT_THAT(of_drive(rpdo1("[0x6040, 0x607A, 0x6060]")), Not(HasSubstr("[mode]")));
  EXPECT_THAT(of_drive(rpdo1("[0x6040, 0x607A]") + ", sdo: [{index: 0x6060, value: 8}]"),
              Not(HasSubstr("[mode]")));
  EXPECT_THAT(of_drive(rpdo1("[0x6040]")), Not(HasSubstr("[mode]"))) << "without set-points";
  EXPECT_THAT(of_drive(rpdo1("[0x6040, 0x607A]") + ", profile: none"), Not(HasSubstr("[mode]")));
}

TEST_F(Careful, TheModeThatIsAdvisedIsThatOfTheSetPoint) {
  EXPECT_THAT(of_drive(rpdo1("[0x6040, 0x607A]")),
              HasSubstr("value: 8}]` (cyclic synchronous position)"));
  EXPECT_THAT(of_drive(rpdo1("[0x6040, 0x60FF]")),
              HasSubstr("value: 9}]` (cyclic synchronous velocity)"));
  EXPECT_THAT(of_drive(rpdo1("[0x6040, 0x6071]")),
              HasSubstr("value: 10}]` (cyclic synchronous torque)"));
}

TEST_F(Careful, AModeOfZeroIsNoMode) {
  EXPECT_THAT(of_drive(rpdo1("[0x6040, 0x607A]") + ", sdo: [{index: 0x6060, value: 0}]"),
              AllOf(HasSubstr("carries 607A:00, but `sdo` sets the mode of operation, 6060:00, to "
                              "0, which is no mode: the drive may ignore the set-points"),
                    HasSubstr("[mode]")));
  EXPECT_THAT(of_drive(rpdo1("[0x6040, 0x607A]") + ", sdo: [{index: 0x6060, value: -1}]"),
              Not(HasSubstr("[mode]")))
      << "a mode of the manufacturer";
}

TEST_F(Careful, AModeThatTheBootDoesNotWriteIsNotSet) {
  const std::string reported =
      of_drive(rpdo1("[0x6040, 0x607A]") + ", boot: false, sdo: [{index: 0x6060, value: 8}]");

  EXPECT_THAT(reported,
              AllOf(HasSubstr("nothing sets the mode of operation, 6060:00 (`boot: false` "
                              "writes no `sdo`): the drive may ignore the set-points. Map "
                              "0x6060 into an RPDO [mode]"),
                    Not(HasSubstr("or write"))));
}

TEST_F(Careful, AModeThatNoTpdoShowsIsToBeMappedToo) {
  const std::string rpdos = rpdo1("[0x6040, 0x607A]");
  EXPECT_THAT(of_drive(rpdos + ", " + tpdo1("transmission: 1, mapping: [0x6041, 0x6064]")),
              HasSubstr("(cyclic synchronous position) and map 0x6061 into a TPDO [mode]"));
  EXPECT_THAT(of_drive(rpdos + ", " + tpdo1("transmission: 1, mapping: [0x6041, 0x6061]")),
              HasSubstr("(cyclic synchronous position) [mode]"));
}

TEST_F(Careful, AnRpdoWithAnErrorDoesNotAskForAMode) {
  const std::string reported = of_drive(
      "rpdo: {1: {transmission: 1, mapping: [0x6040, 0x607A]}, 2: {transmission: 1, mapping: "
      "[6060h]}, 3: {enabled: false}, 4: {enabled: false}}");

  EXPECT_THAT(reported,
              AllOf(HasSubstr("`6060h` is not a whole number"), Not(HasSubstr("[mode]"))));
}

// on_loss

TEST_F(Careful, SeveralDrivesWithoutADecisionOnTheLossOfOneAreAWarning) {
  const auto two = [&](const std::string& keys) {
    return reported_of(
        std::string{"bus: {name: lift}\nmaster: {sync_period: 10000}\nnodes:\n  a: {"} + drive +
        ", node_id: 1" + keys + "}\n  b: {" + drive + ", node_id: 2" + keys + "}\n");
  };
  EXPECT_THAT(two(""), AllOf(HasSubstr("when one of `a`, `b` is lost: they would continue. Write "
                                       "`on_loss: quick_stop`"),
                             HasSubstr("[on-loss]")));
  EXPECT_THAT(two(", on_loss: report"), Not(HasSubstr("[on-loss]")));
  EXPECT_THAT(two(", on_loss: quick_stop"), Not(HasSubstr("[on-loss]")));
  EXPECT_THAT(of_drive("mandatory: true"), Not(HasSubstr("[on-loss]"))) << "one drive alone";
}

TEST_F(Careful, NmtStopOfADriveThatMakesNoQuickStopByItselfIsAWarning) {
  const auto two = [&](const std::string& of_a, const std::string& of_b) {
    return reported_of(
        std::string{"bus: {name: lift}\nmaster: {sync_period: 10000}\nnodes:\n  a: {"} + drive +
        ", node_id: 1, group: z, " + of_a + "}\n  b: {" + drive + ", node_id: 2, group: z, " +
        of_b + "}\n");
  };
  const std::string stops = "sdo: [{index: 0x6007, value: 3}]";
  EXPECT_THAT(
      two("on_loss: stop_group", "on_loss: report"),
      AllOf(HasSubstr("when node `a` is lost, the master sends NMT stop to `a`, `b` at once"),
            HasSubstr("Write `sdo: [{index: 0x6007, value: 3}]`, or `on_loss: quick_stop`"),
            HasSubstr("[on-loss]")));
  EXPECT_THAT(two("on_loss: stop_group", "on_loss: report"), Not(HasSubstr("device file of")));
  EXPECT_THAT(two("on_loss: stop_group, " + stops, "on_loss: report"),
              HasSubstr("sends NMT stop to `b` at once"));
  EXPECT_THAT(two("on_loss: stop_group, " + stops, "on_loss: report, " + stops),
              Not(HasSubstr("[on-loss]")));
  EXPECT_THAT(two("on_loss: stop_node, " + stops, "on_loss: report"), Not(HasSubstr("[on-loss]")));
  EXPECT_THAT(two("on_loss: stop_node", "on_loss: report"),
              HasSubstr("sends NMT stop to `a` at once"));
  EXPECT_THAT(two("on_loss: quick_stop", "on_loss: report"), Not(HasSubstr("[on-loss]")));
}

// times of event-driven PDOs

TEST_F(Careful, ATpdoMayBeLateByItsInhibitTime) {
  of_drive(tpdo1("transmission: 255, event_timer: 50, inhibit_time: 1000"));
  EXPECT_EQ(deadline_of_first(), std::chrono::milliseconds{75 + 100 + 10});
  of_drive(tpdo1("transmission: 255, event_timer: 50"));
  EXPECT_EQ(deadline_of_first(), std::chrono::milliseconds{75 + 10});
}

TEST_F(Careful, AnEventTimerBelowTheInhibitTimeIsAWarning) {
  EXPECT_THAT(of_drive(tpdo1("transmission: 255, event_timer: 50, inhibit_time: 1000")),
              AllOf(HasSubstr("the event timer of TPDO1 of node `a` (50 ms) is shorter than its "
                              "inhibit time (100 ms): the device sends the PDO every 100 ms. Write "
                              "`event_timer` of at least 100 (ms)"),
                    HasSubstr("[event-timer]")));
  EXPECT_THAT(of_drive(tpdo1("transmission: 255, event_timer: 100, inhibit_time: 1000")),
              Not(HasSubstr("[event-timer]")));
  EXPECT_THAT(of_drive(tpdo1("transmission: 1, event_timer: 50, inhibit_time: 1000")),
              Not(HasSubstr("[event-timer]")));
}

TEST_F(Careful, AnEventDeadlineBelowTheEventTimerIsAWarningWithoutAnInhibitTimeToo) {
  EXPECT_THAT(of_drive(tpdo1("transmission: 255, event_timer: 50, event_deadline: 40")),
              HasSubstr("`event_deadline` of TPDO1 of node `a` (40 ms) is shorter than the time "
                        "between two of its frames (50 ms by its event timer): good frames count "
                        "as missing"));
  EXPECT_THAT(of_drive(tpdo1("transmission: 255, event_timer: 50, event_deadline: 50")),
              Not(HasSubstr("[event-timer]")));
  EXPECT_THAT(of_drive(tpdo1("transmission: 255, event_deadline: 40")),
              Not(HasSubstr("[event-timer]")));
}

TEST_F(Careful, AnEventDeadlineBelowTheInhibitTimeIsAWarning) {
  EXPECT_THAT(
      of_drive(tpdo1("transmission: 255, event_timer: 100, inhibit_time: 1000, event_deadline: "
                     "80")),
      HasSubstr("`event_deadline` of TPDO1 of node `a` (80 ms) is shorter than the time between "
                "two of its frames (100 ms by its inhibit time): good frames count as missing"));
}

TEST_F(Careful, AnInhibitTimeBelowTheFrameIsAWarning) {
  // 6 bytes take up to 115 bit times: 920 us at 125 kbit/s, 115 us at 1000 kbit/s.
  EXPECT_THAT(of_drive(tpdo1("transmission: 255, inhibit_time: 5"), ", bitrate_kbit: 125"),
              AllOf(HasSubstr("the inhibit time of TPDO1 of node `a` (500 us) is shorter than its "
                              "frame (up to "),
                    HasSubstr("at 125 kbit/s"), HasSubstr("[inhibit-time]")));
  EXPECT_THAT(of_drive(tpdo1("transmission: 255, inhibit_time: 5")),
              Not(HasSubstr("[inhibit-time]")));
  EXPECT_THAT(of_drive(tpdo1("transmission: 255, inhibit_time: 0"), ", bitrate_kbit: 125"),
              Not(HasSubstr("[inhibit-time]")));
}

// COB-IDs

TEST_F(Careful, AnExplicitCobIdThatAnotherTpdoHasIsAnError) {
  const std::string reported = reported_of(
      std::string{"bus: {name: lift}\nmaster: {sync_period: 10000}\nnodes:\n  a: {"} + drive +
      ", node_id: 1}\n  b: {" + drive + ", node_id: 2, tpdo: {1: {cob_id: 0x181}}}\n");
  EXPECT_THAT(
      reported,
      AllOf(HasSubstr(
                "error: `cob_id` 0x181 of TPDO1 of node `b` is also used by TPDO1 of node `a` in "),
            HasSubstr("[cob-id-clash]"), Not(HasSubstr("[cob-id-moved]"))));
  EXPECT_EQ(reported.find("error"), reported.rfind("error"))
      << "one cause, one error: " << reported;
}

TEST_F(Careful, ATpdoAndAnRpdoOfTwoDevicesRemainALink) {
  EXPECT_THAT(
      reported_of(std::string{"bus: {name: lift}\nmaster: {sync_period: 10000}\nnodes:\n  a: {"} +
                  drive + ", node_id: 1}\n  b: {" + drive +
                  ", node_id: 2, rpdo: {1: {cob_id: 0x181}}}\n"),
      AllOf(HasSubstr("[linked]"), Not(HasSubstr("error"))));
}

// shared lines

TEST_F(Careful, AMistakeUnderAnAnchorIsOneErrorForAllNodesThatMergeIt) {
  const std::string reported = reported_of(
      "bus: {name: lift}\nmaster: {sync_period: 10000}\n.axis: &axis\n  " + std::string{drive} +
      "\n  sdo: [{index: 0x6060, value: 300}]\n  tpdo: {1: {mapping: [0x6041, 0x9999]}}\n"
      "nodes:\n  a: {<<: *axis, node_id: 1}\n  b: {<<: *axis, node_id: 2}\n"
      "  c: {<<: *axis, node_id: 3}\n");

  std::size_t errors = 0;
  for (std::size_t at = reported.find(" error: "); at != reported.npos;
       at = reported.find(" error: ", at + 1)) {
    ++errors;
  }
  EXPECT_EQ(errors, 2u) << reported;
  EXPECT_THAT(reported, AllOf(HasSubstr("net.yaml:5:"), HasSubstr("net.yaml:6:"),
                              HasSubstr("; the same applies to `b`, `c`, which share this line")));
}

TEST_F(Careful, OneOtherNodeSharesTheLine) {
  EXPECT_THAT(reported_of("bus: {name: lift}\nmaster: {sync_period: 10000}\n.axis: &axis\n  " +
                          std::string{drive} +
                          "\n  sdo: [{index: 0x6060, value: 300}]\n"
                          "nodes:\n  a: {<<: *axis, node_id: 1}\n  b: {<<: *axis, node_id: 2}\n"),
              HasSubstr("; the same applies to `b`, which shares this line"));
}

TEST_F(Careful, TwoMistakesOfOneNodeInOneLineStayTwo) {
  const std::string reported =
      of_drive("sdo: [{index: 0x6060, value: 300}, {index: 0x6060, value: 301}]");
  EXPECT_THAT(reported, AllOf(HasSubstr("not 300"), HasSubstr("not 301")));
}

// messages

TEST_F(Careful, ANumberThatDoesNotFitIsReportedTheRangeAndTheBits) {
  EXPECT_THAT(of_drive("sdo: [{index: 0x6060, value: 300}]"),
              HasSubstr("(INTEGER8) holds -128..127, or 0x80..0xFF as bits, not 300"));
  EXPECT_THAT(of_drive("sdo: [{index: 0x6060, value: 0xFF}]"), Not(HasSubstr("error")));
}

TEST_F(Careful, AnIndexWithout0xIsReportedHowItIsWritten) {
  for (const char* keys : {"tpdo: {1: {mapping: [{index: 607A}]}}", "tpdo: {1: {mapping: [607A]}}",
                           "tpdo: {1: {mapping: [607A:0]}}", "sdo: [{index: 607A, value: 1}]"}) {
    const std::string reported = of_drive(keys);
    EXPECT_THAT(reported, HasSubstr("`607A` is hexadecimal without 0x: write 0x607A")) << keys;
    EXPECT_EQ(reported.find("error"), reported.rfind("error"))
        << "one cause, one error: " << reported;
  }
}

TEST_F(Careful, AMappingMayBeWrittenShort) {
  const std::string reported = of_drive(tpdo1("transmission: 1, mapping: [0x6041, 0x6064:0]"));
  EXPECT_THAT(reported, Not(HasSubstr("error")));
  ASSERT_EQ(plan_.pdos.tpdos.size(), 1u);
  EXPECT_EQ(plan_.pdos.tpdos[0].length, 6);
  EXPECT_EQ(plan_.layout.signals[1].object, (ObjectKey{0x6064, 0}));
}

TEST_F(Careful, TheSubIndexOfTheShortFormIsHexadecimal) {
  EXPECT_THAT(of_drive("tpdo: {1: {mapping: [0x1018:1F]}}"), HasSubstr("1018:1F"));
  EXPECT_THAT(
      of_drive("tpdo: {1: {mapping: [0x6064:100]}}"),
      HasSubstr(
          "`0x6064:100` is not an object: write 0x6064, or 0x6064:0 with the sub-index in hex"));
  EXPECT_THAT(of_drive("tpdo: {1: {mapping: [0x6064:]}}"), HasSubstr("error"));
}

TEST_F(Careful, ALongestPauseBelowTheFirstOneIsAnError) {
  EXPECT_THAT(of_drive("reboot_delay_ms: 2000, reboot_delay_max_ms: 1000"),
              HasSubstr("`reboot_delay_max_ms` of node `a` is shorter than its `reboot_delay_ms`"));
}

}  // namespace
}  // namespace takt
