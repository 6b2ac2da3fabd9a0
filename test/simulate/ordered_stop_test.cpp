#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "apps/takt/simulate/simulation.hpp"
#include "test/simulate/lift.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::machine;

bool warns(const LoadedNetwork& network, const std::string& text) {
  for (const Finding& finding : network.findings) {
    if (finding.message.find(text) != std::string::npos) return true;
  }
  return false;
}

TEST(OrderedStopOfABus, IsConfirmedWhereEveryDriveStopsAndIsDisabled) {
  const test::Folder folder;
  const auto outcome = simulate(machine(folder), {.duration = 4300ms, .move = true});
  EXPECT_EQ(outcome.axes_moved, 2U);
  EXPECT_TRUE(outcome.stopped);
  EXPECT_EQ(outcome.stop, StopResult::confirmed);
  EXPECT_TRUE(outcome.unconfirmed.empty());
}

TEST(OrderedStopOfABus, ReportsAtWhichVelocityADriveWasDisabled) {
  const test::Folder folder;
  const auto network =
      machine(folder, {.master = ", stop_timeout: 1000", .sdo = "{index: 0x6085, value: 100}"});
  EXPECT_TRUE(warns(network, "`z` needs"));

  const auto outcome = simulate(network, {.duration = 4300ms, .move = true});

  EXPECT_TRUE(outcome.stopped);
  EXPECT_EQ(outcome.stop, StopResult::unconfirmed);
  ASSERT_EQ(outcome.unconfirmed.size(), 1U);
  EXPECT_EQ(outcome.unconfirmed[0].find("z was disabled at "), 0U) << outcome.unconfirmed[0];
  EXPECT_NE(outcome.unconfirmed[0].find("mm/s"), std::string::npos) << outcome.unconfirmed[0];
}

// The time covers a ramp of 6 s, a quarter more for its detection, and the other stages.
TEST(OrderedStopOfABus, HasTheTimeThatTheSlowestRampNeeds) {
  const test::Folder folder;
  const auto network =
      machine(folder, {.sdo = "{index: 0x607F, value: 600000}, {index: 0x6085, value: 100000}"});

  EXPECT_FALSE(warns(network, "`z` needs"));
  EXPECT_EQ(network.plan.nodes[1].axes.at(0).stopping_time, 6s);
  EXPECT_EQ(network.plan.stop_timeout, 9375ms);
}

TEST(OrderedStopOfABus, WarnsWithBothNumbersWhereTheTimeIsTooShort) {
  const test::Folder folder;
  const auto network =
      machine(folder, {.master = ", stop_timeout: 5000",
                       .sdo = "{index: 0x607F, value: 600000}, {index: 0x6085, value: 100000}"});

  EXPECT_TRUE(warns(network,
                    "drive `z` needs 6.0 s to stop from its velocity limit (607F, 6080, `limits:`) "
                    "along the ramp 6085:00; the ordered stop waits 4.0 s"));
  EXPECT_TRUE(warns(network, "Write `master: {stop_timeout: 9400}`, or a steeper ramp"));
}

TEST(OrderedStopOfABus, NeverLastsLongerThanHalfAMinuteByDefault) {
  const test::Folder folder;
  const auto network =
      machine(folder, {.sdo = "{index: 0x607F, value: 600000}, {index: 0x6085, value: 1000}"});

  EXPECT_EQ(network.plan.stop_timeout, 30s);
  EXPECT_TRUE(warns(network, "drive `z` needs 600.0 s"));
}

TEST(OrderedStopOfABus, WarnsOfADriveThatCoasts) {
  const test::Folder folder;
  EXPECT_TRUE(warns(machine(folder, {.sdo = "{index: 0x605A, value: 0}"}), "`z` coasts"));
}

TEST(OrderedStopOfABus, DisablesADriveThatStaysInQuickStop) {
  const test::Folder folder;
  const auto outcome = simulate(machine(folder, {.sdo = "{index: 0x605A, value: 6}"}),
                                {.duration = 4300ms, .move = true});
  EXPECT_EQ(outcome.stop, StopResult::confirmed);
}

/// The devices report a lost master after 300 ms (0x1016), so 3 s of silence are long enough.
constexpr Time silence = 3s;

TEST(OrderedStopOfABus, LeavesNoDeviceThatMissesItsMaster) {
  const test::Folder folder;
  for (const std::string way : {"sdo", "reset_communication"}) {
    const auto network = machine(folder, {.master = ", stop_disarm: " + way, .sdo = ""});
    const auto outcome = simulate(network, {.duration = 4300ms, .move = true, .after = silence});
    EXPECT_EQ(outcome.stop, StopResult::confirmed) << way;
    EXPECT_EQ(outcome.emcy_after, 0U) << way;
  }
}

/// Returns the SDO writes of the master to node 1 after the start of the stop, as in the candump
/// log.
std::vector<std::string> written_in_the_stop(const LoadedNetwork& network,
                                             const test::Folder& folder) {
  const std::string log = folder.path() / "log";
  const auto outcome =
      simulate(network, {.duration = 4300ms, .move = true, .after = silence, .candump = log});
  EXPECT_EQ(outcome.stop, StopResult::confirmed);
  EXPECT_EQ(outcome.emcy_after, 0U);
  std::vector<std::string> written;
  std::ifstream in{log};
  for (std::string line; std::getline(in, line);) {
    const std::size_t id = line.rfind(' ') + 1;
    const bool download = line.compare(id, 5, "601#2") == 0;
    if (download && std::stod(line.substr(1)) > 4.3) written.push_back(line.substr(id));
  }
  return written;
}

constexpr const char* with_sync = "sync_period: 4000";
constexpr const char* without_sync = "cycle: 4000";

/// A network with one drive that has life guarding and a master without a heartbeat; `node` adds
/// keys to the drive.
LoadedNetwork guarded(const test::Folder& folder, const std::string& node,
                      const std::string& period = with_sync) {
  return load_network(folder.write("net.yaml",
                                   "bus: {name: lift, bitrate_kbit: 1000}\n"
                                   "master: {heartbeat_producer: 0, " +
                                       period +
                                       "}\n"
                                       "nodes:\n"
                                       "  y:\n"
                                       "    node_id: 1\n"
                                       "    dcf: " TAKT_SOURCE_DIR
                                       "/share/eds/astraada_drv28.eds\n" +
                                       node));
}

constexpr const char* life_guarding =
    "    heartbeat_producer: 0\n    guard_time: 100\n    life_time_factor: 3\n";

TEST(OrderedStopOfABus, DisarmsLifeGuardingAloneWithBothOfItsObjects) {
  const test::Folder folder;
  const auto network = guarded(folder, life_guarding, without_sync);
  EXPECT_FALSE(network.plan.cycle.sync);
  EXPECT_EQ(written_in_the_stop(network, folder),
            (std::vector<std::string>{"601#2B0C100000000000", "601#2F0D100000000000"}));
}

TEST(OrderedStopOfABus, DisarmsLifeGuardingAndThePeriodOfSync) {
  const test::Folder folder;
  EXPECT_EQ(written_in_the_stop(guarded(folder, life_guarding), folder),
            (std::vector<std::string>{"601#2B0C100000000000", "601#2F0D100000000000",
                                      "601#2306100000000000"}));
}

TEST(OrderedStopOfABus, DisarmsThePeriodOfSyncAlone) {
  const test::Folder folder;
  const auto network = guarded(folder, "    heartbeat_producer: 0\n    retry_factor: 0\n");
  EXPECT_EQ(written_in_the_stop(network, folder),
            (std::vector<std::string>{"601#2306100000000000"}));
}

TEST(OrderedStopOfABus, DisarmsNothingOfANodeThatIsKeptAlive) {
  const test::Folder folder;
  const auto network = guarded(folder, std::string{life_guarding} + "    reset: keep_alive\n");
  const auto outcome = simulate(network, {.duration = 4300ms, .after = silence});
  EXPECT_NE(outcome.emcy_after, 0U) << "it is to miss its master";
}

TEST(OrderedStopOfABus, LeavesTheDevicesArmedWhereAnAxisIsNotConfirmed) {
  const test::Folder folder;
  const auto network =
      machine(folder, {.master = ", stop_timeout: 1000", .sdo = "{index: 0x6085, value: 100}"});
  const auto outcome = simulate(network, {.duration = 4300ms, .move = true, .after = silence});
  EXPECT_EQ(outcome.stop, StopResult::unconfirmed);
  EXPECT_NE(outcome.emcy_after, 0U);
}

}  // namespace
}  // namespace takt
