#include "apps/takt/simulate/simulation.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <unistd.h>

#include "apps/takt/simulate/outcome_report.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

const LoadedNetwork& demo() {
  static const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");
  return network;
}

std::string json(const SimulationOptions& options) {
  std::ostringstream text;
  print_json(text, simulate(demo(), options));
  return text.str();
}

TEST(Simulation, BootsAllNodesAndMovesTheAxes) {
  const auto outcome = simulate(demo(), {.duration = 5s, .move = true});

  EXPECT_TRUE(outcome.stopped);
  EXPECT_FALSE(outcome.mandatory_failed);
  EXPECT_EQ(outcome.axes_moved, 2u);
  for (const NodeOutcome& node : outcome.nodes) {
    EXPECT_TRUE(node.first_boot.has_value()) << node.name;
    EXPECT_EQ(node.boot_failures, 0u) << node.name;
    EXPECT_GT(node.tpdo_frames, 2000u) << node.name;
    EXPECT_EQ(node.tpdo_missing, 0u) << node.name;
    EXPECT_EQ(node.status.emcy_count, 0u) << node.name;
  }
}

TEST(Simulation, ADomainGetsItsFileAtBoot) {
  const test::Folder folder;
  const std::string eds = TAKT_SOURCE_DIR "/share/eds/plain301.eds";
  std::filesystem::copy_file(eds, folder / "cam.dcf");
  std::ofstream{folder / "cam.dcf", std::ios::app}
      << "\n[2F00]\nParameterName=Cam table\nObjectType=0x2\nDataType=0xF\nAccessType=wo\n"
         "DownloadFile=cam.bin\n";
  std::ofstream{folder / "cam.bin"} << "12345678";
  std::ofstream{folder / "net.yaml"} << "bus: {name: b, bitrate_kbit: 500}\n"
                                        "master: {sync_period: 10000}\n"
                                        "nodes:\n  arm: {dcf: cam.dcf, node_id: 5}\n";
  const auto log = folder / "log";

  const auto outcome =
      simulate(load_network(folder / "net.yaml"), {.duration = 2s, .candump = log.string()});

  ASSERT_EQ(outcome.nodes.size(), 1u);
  EXPECT_EQ(outcome.nodes[0].boot_failures, 0u);
  EXPECT_TRUE(outcome.nodes[0].first_boot.has_value());
  std::ostringstream text;
  text << std::ifstream{log}.rdbuf();
  EXPECT_NE(text.str().find(" 605#21002F0008000000"), std::string::npos);
  EXPECT_NE(text.str().find(" 605#0031323334353637"), std::string::npos);
}

TEST(Simulation, CountsPdosWith29BitIdentifiers) {
  const auto outcome = simulate(
      load_network(TAKT_SOURCE_DIR "/test/simulate/data/extended_ids.yaml"), {.duration = 2s});

  ASSERT_EQ(outcome.nodes.size(), 1u);
  EXPECT_GT(outcome.nodes[0].tpdo_frames, 180u + 30u);  // one frame every 10 ms and one every 50 ms
  EXPECT_GT(outcome.nodes[0].rpdo_frames, 170u);
  EXPECT_EQ(outcome.nodes[0].tpdo_missing, 0u);
  EXPECT_EQ(outcome.nodes[0].tpdo_late, 0u);
}

/// Returns the payload of the last frame with an identifier in a candump log.
std::string last_payload(const std::filesystem::path& log, const std::string& id) {
  std::ifstream in{log};
  std::string found;
  for (std::string line; std::getline(in, line);) {
    const std::size_t at = line.find(" " + id + "#");
    if (at != std::string::npos) found = line.substr(at + id.size() + 2);
  }
  return found;
}

TEST(Simulation, Maps64EntriesOfOneBitInTheOrderOfTheFile) {
  const test::Folder folder;
  const auto log = folder / "log";
  const auto outcome = simulate(load_network(TAKT_SOURCE_DIR "/test/simulate/data/bits.yaml"),
                                {.duration = 2s, .candump = log.string()});
  const std::string outputs = last_payload(log, "205");
  const std::string inputs = last_payload(log, "185");

  ASSERT_EQ(outcome.nodes.size(), 1u);
  EXPECT_TRUE(outcome.nodes[0].first_boot.has_value());
  EXPECT_EQ(outputs, "5555555555555555");  // odd sub-indices are 1, in rising order
  EXPECT_EQ(inputs, "9224499224499224");   // each third sub-index is 1, from 64 down
}

TEST(Simulation, CountsTheTimeBeforeTheFirstSyncAsNoCycle) {
  LoadedNetwork network = demo();
  network.plan.cycle.period = 20ms;

  const auto outcome = simulate(network, {.duration = 3s});

  // A cycle of 20 ms has 20,000 bits; the boot before SYNC would have more.
  EXPECT_GT(outcome.worst_cycle_bits, 500u);
  EXPECT_LT(outcome.worst_cycle_bits, 20'000u);
}

TEST(Simulation, SendsNoSyncCounterToADeviceThatStillExpectsNone) {
  LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/test/simulate/data/counter.yaml");

  const auto outcome = simulate(network, {.duration = 2s});

  EXPECT_GT(outcome.sync.count, 150u);
  for (const NodeOutcome& node : outcome.nodes) {
    EXPECT_EQ(node.status.boot_count, 1u) << node.name;
    EXPECT_EQ(node.status.emcy_count, 0u) << node.name << ": EMCY 0x8240";
  }
}

TEST(Simulation, GivesTheSameJsonForTheSameSeed) {
  SimulationOptions options{.duration = 2s, .seed = 7, .move = true, .wake_jitter = 80us};
  options.faults.push_back({.kind = sim::FaultKind::error_frames, .probability = 0.01});
  options.faults.push_back({.kind = sim::FaultKind::loss, .node = 2_node, .probability = 0.01});

  const std::string first = json(options);

  EXPECT_EQ(first, json(options));
  options.seed = 8;
  EXPECT_NE(first, json(options));
}

TEST(Simulation, BootsANodeAgainThatWasSwitchedOffAndOn) {
  SimulationOptions options{.duration = 6s, .move = true};
  options.faults.push_back(
      {.kind = sim::FaultKind::power_off, .node = 2_node, .at = 2s, .until = 3s});

  const auto outcome = simulate(demo(), options);

  EXPECT_EQ(outcome.nodes[0].status.boot_count, 1u);
  EXPECT_EQ(outcome.nodes[1].status.boot_count, 2u);
  EXPECT_GT(outcome.nodes[1].tpdo_missing, 0u);
  EXPECT_EQ(outcome.nodes[0].tpdo_missing, 0u) << "the others keep cycling";
}

TEST(Simulation, BootsANodeThatComesBackUnderARunningSyncCounterAtTheFirstTry) {
  const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/test/simulate/data/counter.yaml");
  for (const Time off : {20ms, 290ms, 1000ms}) {
    SimulationOptions options{.duration = 6s};
    options.faults.push_back(
        {.kind = sim::FaultKind::power_off, .node = 1_node, .at = 2s, .until = 2s + off});

    const auto outcome = simulate(network, options);

    EXPECT_EQ(outcome.nodes[0].boot_failures, 0u) << off.count();
    EXPECT_EQ(outcome.nodes[0].status.boot_count, 2u) << off.count();
  }
}

TEST(Simulation, ASlowSyncSlowsNeitherBootNorHeartbeat) {
  const auto outcome = simulate(load_network(TAKT_SOURCE_DIR "/test/simulate/data/slow_sync.yaml"),
                                {.duration = 6s});

  for (const NodeOutcome& node : outcome.nodes) {
    ASSERT_TRUE(node.first_boot.has_value()) << node.name;
    EXPECT_LT(*node.first_boot, 2s) << node.name << ": the first SYNC comes after a second";
    EXPECT_EQ(node.status.emcy_count, 0u) << node.name << ": the master's heartbeat was late";
    EXPECT_EQ(node.tpdo_missing, 0u) << node.name;
  }
}

TEST(Simulation, ReportsWhyANodeWithAnotherVendorDoesNotBoot) {
  SimulationOptions options{.duration = 2s};
  options.faults.push_back({.kind = sim::FaultKind::override_value,
                            .node = 1_node,
                            .object = ObjectKey{0x1018, 1},
                            .value = {std::byte{0x43}, std::byte{}, std::byte{}, std::byte{}}});

  const auto outcome = simulate(demo(), options);

  EXPECT_TRUE(outcome.mandatory_failed);
  EXPECT_TRUE(std::ranges::any_of(outcome.events, [](const ReportedEvent& event) {
    return event.kind == EventKind::boot_failed && event.text.contains("1018:01");
  }));
}

TEST(Simulation, DisturbsTheBeatByNotMoreThanAFrameOfOthers) {
  const auto outcome = simulate(demo(), {.duration = 5s, .move = true});

  EXPECT_EQ(outcome.sync.quantile(0.5), 0us);
  EXPECT_GE(outcome.sync.shortest, outcome.period - 138us);
  EXPECT_LE(outcome.sync.longest, outcome.period + 138us);
  EXPECT_EQ(outcome.loop.cycles_missed, 0u);
  EXPECT_EQ(outcome.sync.gaps, 0u);
}

TEST(Simulation, SkipsCyclesAfterAStallWithoutABurst) {
  SimulationOptions options{.duration = 2s};
  options.faults.push_back({.kind = sim::FaultKind::stall_master, .at = 1s, .until = 1050ms});

  const auto outcome = simulate(demo(), options);

  EXPECT_GE(outcome.loop.cycles_missed, 24u);
  EXPECT_EQ(outcome.sync.gaps, 1u);
  EXPECT_GE(outcome.sync.shortest, outcome.period - 200us);
}

}  // namespace
}  // namespace takt
