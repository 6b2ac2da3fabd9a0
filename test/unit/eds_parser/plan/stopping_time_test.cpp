// The stopping time of a drive, and the velocity below which the drive counts as standing still.
#include <gtest/gtest.h>
#include <string>

#include "test/unit/eds_parser/plan/tiny_network.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::entry;
using test::record;

struct Values {
  std::string sdo{};   ///< SDO values in the network file
  std::string node{};  ///< additional keys of the node
  std::string master{};
};

/// Makes a drive with all objects for velocity limit and ramps; all values are 0.
std::string drive_eds() {
  return test::tiny_eds() + entry("605A", "Quick stop option code", 3, "rw", "2") +
         entry("605C", "Disable operation option code", 3, "rw", "1") +
         entry("6067", "Position window", 7, "rw", "0") +
         entry("606F", "Velocity threshold", 6, "rw", "0") +
         entry("607F", "Max profile velocity", 7, "rw", "0") +
         entry("6080", "Max motor speed", 7, "rw", "0") +
         entry("6084", "Profile deceleration", 7, "rw", "0") +
         entry("6085", "Quick stop deceleration", 7, "rw", "0") + record("6091", "Gear ratio", 3) +
         entry("6091sub0", "highest", 5, "const", "2") +
         entry("6091sub1", "Motor revolutions", 7, "rw", "0") +
         entry("6091sub2", "Shaft revolutions", 7, "rw", "0") + record("6092", "Feed", 3) +
         entry("6092sub0", "highest", 5, "const", "2") + entry("6092sub1", "Feed", 7, "rw", "0") +
         entry("6092sub2", "Shaft revolutions", 7, "rw", "0");
}

test::Compiled drive(const Values& values) {
  return test::compile("master: {sync_period: 10000" + values.master +
                           "}\n"
                           "nodes:\n"
                           "  z:\n"
                           "    node_id: 5\n"
                           "    dcf: tiny.eds\n" +
                           values.node + "    sdo: [" + values.sdo + "]\n",
                       drive_eds());
}

const AxisPlan& axis(const test::Compiled& network) { return network.plan.nodes[0].axes.at(0); }

// 3000 revolutions of the motor in a minute, a gear of 5, 10000 positions for each turn of the
// shaft: 100000 in a second, which 6085 brings to rest within 40 s.
const std::string behind_the_gear =
    "{index: 0x6080, value: 3000}, {index: 0x6091, sub_index: 1, value: 5}, "
    "{index: 0x6091, sub_index: 2, value: 1}, {index: 0x6092, sub_index: 1, value: 10000}, "
    "{index: 0x6092, sub_index: 2, value: 1}";

TEST(StoppingTime, IsThatOfTheMotorsSpeedBehindItsGear) {
  const auto network = drive({.sdo = behind_the_gear + ", {index: 0x6085, value: 2500}"});
  EXPECT_EQ(axis(network).stopping_time, 40s);
  EXPECT_EQ(network.plan.stop_timeout, 30s) << "62.5 s would be needed";
  EXPECT_NE(network.declared("stop-time")
                .find("drive `z` needs 40.0 s to stop from its velocity limit (607F, 6080, "
                      "`limits:`) along the ramp 6085:00; the ordered stop waits 24.0 s"),
            std::string::npos)
      << network.declared("stop-time");
}

TEST(StoppingTime, IsThatOfTheLowerLimit) {
  const std::string lower = ", {index: 0x607F, value: 40000}, {index: 0x6085, value: 10000}";
  EXPECT_EQ(axis(drive({.sdo = behind_the_gear + lower})).stopping_time, 4s);
  const std::string higher = ", {index: 0x607F, value: 400000}, {index: 0x6085, value: 10000}";
  EXPECT_EQ(axis(drive({.sdo = behind_the_gear + higher})).stopping_time, 10s);
}

TEST(StoppingTime, IsAlongTheSlowDownRampWhereTheOptionCodeSaysSo) {
  for (const std::string option : {"1", "5"}) {
    const auto network = drive({.sdo = "{index: 0x605A, value: " + option +
                                       "}, {index: 0x607F, value: 60000}, "
                                       "{index: 0x6084, value: 10000}, "
                                       "{index: 0x6085, value: 60000}",
                                .master = ", stop_timeout: 5000"});
    EXPECT_EQ(axis(network).stopping_time, 6s) << option;
    EXPECT_NE(network.declared("stop-time")
                  .find("needs 6.0 s to stop from its velocity limit (607F, 6080, `limits:`) along "
                        "the ramp 6084:00; the ordered stop waits 4.0 s"),
              std::string::npos)
        << network.declared("stop-time");
  }
}

TEST(StoppingTime, IsNotKnownWhereTheDriveStopsAtItsCurrentLimit) {
  for (const std::string option : {"3", "4", "7", "8"}) {
    const auto network = drive({.sdo = "{index: 0x605A, value: " + option +
                                       "}, {index: 0x607F, value: 60000}, "
                                       "{index: 0x6085, value: 10}"});
    EXPECT_EQ(axis(network).stopping_time, Time{}) << option;
  }
}

// "Disable operation" is not part of the stop, which uses quick stop, and disable voltage at
// standstill.
TEST(StoppingTime, DoesNotDependOnTheOptionCodeOfDisableOperation) {
  for (const std::string option : {"0", "1"}) {
    const auto network = drive({.sdo = "{index: 0x605C, value: " + option +
                                       "}, {index: 0x607F, value: 60000}, "
                                       "{index: 0x6084, value: 1}, {index: 0x6085, value: 10000}"});
    EXPECT_EQ(axis(network).stopping_time, 6s) << option;
    EXPECT_EQ(network.declared("stop-time").find("coasts"), std::string::npos);
  }
}

TEST(StoppingTime, MakesTheStopAtLeastFiveAndAtMostThirtySeconds) {
  const auto of = [](const std::string& deceleration) {
    return drive({.sdo = "{index: 0x607F, value: 100000}, {index: 0x6085, value: " + deceleration +
                         "}"})
        .plan.stop_timeout;
  };
  EXPECT_EQ(of("1000000"), 5s);
  EXPECT_EQ(of("10000"), 15625ms);  // 10 s and a quarter more are 8 tenths of the stop
  EXPECT_EQ(of("1000"), 30s);
}

TEST(StoppingTime, IsThatOfWhatMayBeCommandedWhereThatIsLess) {
  const auto network = drive({.sdo = "{index: 0x607F, value: 60000}, {index: 0x6085, value: 10000}",
                              .node = "    units: {velocity: {scale: 1.0e-3, unit: rad/s}}\n"
                                      "    rpdo: {1: {mapping: [0x6040, 0x60FF]}}\n"
                                      "    limits: {velocity: 20.0}\n"});
  EXPECT_EQ(axis(network).stopping_time, 2s);
}

// velocity window of standstill

TEST(StandstillWindow, IsTheThresholdOfTheDevice) {
  EXPECT_EQ(axis(drive({.sdo = "{index: 0x606F, value: 150}"})).velocity_window, 150);
}

TEST(StandstillWindow, IsAtMostAHundredthOfTheVelocityLimit) {
  const std::string threshold = "{index: 0x606F, value: 5000}, ";
  EXPECT_EQ(axis(drive({.sdo = threshold + "{index: 0x607F, value: 60000}"})).velocity_window, 600);
}

TEST(StandstillWindow, IsAThousandthOfTheLimitWithoutAThreshold) {
  const auto network = drive({.sdo = "{index: 0x607F, value: 2000000}"});
  EXPECT_EQ(axis(network).velocity_window, 2000);
  EXPECT_EQ(axis(network).position_window, 100) << "within 50 ms";
}

TEST(StandstillWindow, IsAThousandthOfWhatMayBeCommandedInTheUnitsOfTheAxis) {
  const auto network = drive({.node = "    units: {velocity: {scale: 1.0e-6, unit: m/s}}\n"
                                      "    rpdo: {1: {mapping: [0x6040, 0x60FF]}}\n"
                                      "    limits: {velocity: 2.0}\n"});
  EXPECT_EQ(axis(network).velocity_window, 2000);
}

TEST(StandstillWindow, IsAHundredthOfARevolutionWithoutAnyLimit) {
  const auto network = drive({.sdo = "{index: 0x6092, sub_index: 1, value: 1000000}, "
                                     "{index: 0x6092, sub_index: 2, value: 1}"});
  EXPECT_EQ(axis(network).velocity_window, 10000);
  EXPECT_EQ(axis(network).position_window, 500);
}

TEST(StandstillWindow, IsThePositionWindowOfTheDeviceWithoutARevolution) {
  const auto network = drive({.sdo = "{index: 0x6067, value: 40}"});
  EXPECT_EQ(axis(network).position_window, 40);
  EXPECT_EQ(axis(network).velocity_window, 800);
}

TEST(StandstillWindow, IsSmallInTheUnitOfTheNetworkFile) {
  const auto network = drive({.node = "    units: {position: {scale: 1.0e-7, unit: m}}\n"});
  EXPECT_EQ(axis(network).velocity_window, 10000) << "1 mm/s";
}

TEST(StandstillWindow, IsReportedWhereNothingIsKnownOfTheAxis) {
  const auto network = drive({});
  EXPECT_EQ(axis(network).velocity_window, 10);
  EXPECT_NE(network.declared("standstill").find("`z` has no velocity threshold (606F)"),
            std::string::npos);
  EXPECT_EQ(drive({.sdo = "{index: 0x606F, value: 150}"}).declared("standstill"), "");
}

}  // namespace
}  // namespace takt
