#include "apps/simulate/simulation.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <sstream>

#include "apps/simulate/outcome_report.hpp"

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

TEST(Simulation, TellsWhyANodeWithAnotherVendorDoesNotBoot) {
  SimulationOptions options{.duration = 2s};
  options.faults.push_back({.kind = sim::FaultKind::override_value,
                            .node = 1_node,
                            .object = ObjectKey{0x1018, 1},
                            .value = {std::byte{0x43}, std::byte{}, std::byte{}, std::byte{}}});

  const auto outcome = simulate(demo(), options);

  EXPECT_TRUE(outcome.mandatory_failed);
  EXPECT_TRUE(std::ranges::any_of(outcome.events, [](const ToldEvent& event) {
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
