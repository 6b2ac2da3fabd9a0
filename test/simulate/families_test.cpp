#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

#include "apps/takt/simulate/simulation.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

SimulationOutcome run(const std::string& family, Time duration) {
  const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/" + family + ".yaml");
  for (const Finding& finding : network.findings) {
    if (finding.severity != Severity::note) ADD_FAILURE() << to_string(finding);
  }
  EXPECT_FALSE(network.plan.nodes.at(0).device_data.empty());
  return simulate(network, {.duration = duration});
}

class Families : public testing::TestWithParam<const char*> {};

TEST_P(Families, BootAndRunWithoutATrouble) {
  const SimulationOutcome outcome = run(GetParam(), 5s);

  EXPECT_TRUE(outcome.stopped);
  for (const NodeOutcome& node : outcome.nodes) {
    EXPECT_TRUE(node.first_boot.has_value()) << node.name;
    EXPECT_EQ(node.boot_failures, 0u) << node.name;
    EXPECT_EQ(node.status.boot_count, 1u) << node.name;
    EXPECT_EQ(node.status.emcy_count, 0u) << node.name;
    EXPECT_EQ(node.tpdo_missing, 0u) << node.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Demos, Families,
                         testing::Values("lenze8400", "beckhoff", "plain301", "astraada_drv28"));

/// Returns the number of TPDO frames of the only node within `span` after the first 5 s.
std::uint64_t frames_within(const std::string& family, Time span) {
  return run(family, 5s + span).nodes.at(0).tpdo_frames - run(family, 5s).nodes.at(0).tpdo_frames;
}

TEST(FamilyTraffic, OfALenzeIsOnePdoASyncAndOneEvery100Ms) {
  EXPECT_EQ(frames_within("lenze8400", 1s), 100u + 10u);  // SYNC every 10 ms
}

TEST(FamilyTraffic, OfTerminalsIsOnePdoASyncAndAnotherAtEachTenth) {
  EXPECT_EQ(frames_within("beckhoff", 1s), 200u + 20u);  // SYNC every 5 ms
}

TEST(FamilyTraffic, OfAPlainDeviceIsByItsEventTimerAndEachSecondSync) {
  EXPECT_EQ(frames_within("plain301", 1s), 20u + 50u);  // timer 50 ms, SYNC every 10 ms
}

TEST(FamilyTraffic, OfADrv28WithoutAChangeIsThatOfItsSynchronousPdo) {
  EXPECT_EQ(frames_within("astraada_drv28", 1s), 100u);  // PDO3 and PDO4 wait for an event
}

/// Returns the number of TPDO frames in the sixth second of a Lenze that produces SYNC itself every
/// 20 ms.
std::uint64_t frames_of_a_producer(const std::string& firmware) {
  const test::Folder folder;
  const auto file =
      folder.write("producer.yaml",
                   "bus: {name: lenze, bitrate_kbit: 500}\n"
                   "conveyor:\n"
                   "  node_id: 3\n"
                   "  dcf: " TAKT_SOURCE_DIR
                   "/share/eds/lenze8400.eds\n"
                   "  device: none\n"  // the device data would refuse this configuration
                   "  sim: {model: lenze8400, firmware: \"" +
                       firmware +
                       "\"}\n"
                       "  tpdo: {1: {transmission: 1}, 2: {transmission: 255, event_timer: 100}}\n"
                       "  sdo:\n"
                       "    - {index: 0x1006, value: 20000}\n"
                       "    - {index: 0x1005, value: 0x40000080}\n");
  const LoadedNetwork network = load_network(file);
  EXPECT_FALSE(has_error(network.findings));
  const auto frames = [&](Time duration) {
    return simulate(network, {.duration = duration}).nodes.at(0).tpdo_frames;
  };
  return frames(6s) - frames(5s);
}

TEST(FamilyTraffic, OfALenzeThatMakesTheSyncBeginsWithFirmware16) {
  EXPECT_EQ(frames_of_a_producer("16.00.00"), 50u + 10u);
  EXPECT_EQ(frames_of_a_producer("15.02"), 10u);
}

}  // namespace
}  // namespace takt
