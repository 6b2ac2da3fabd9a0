#include "eds_parser/budget/budget.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include "apps/simulate/simulation.hpp"
#include "eds_parser/network_file/changed_network.hpp"
#include "master/sim/random.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// TAKT_BUDGET_NETWORKS=5000: so many random networks instead of a few.
unsigned networks() {
  const char* text = std::getenv("TAKT_BUDGET_NETWORKS");
  return text == nullptr ? 60 : static_cast<unsigned>(std::strtoul(text, nullptr, 10));
}

std::string drive(sim::Random& random) {
  static constexpr const char* first[] = {"{index: 0x6041}, {index: 0x6064}", "{index: 0x6041}"};
  const bool second = random.chance(0.5);
  return std::string{"{dcf: "} + TAKT_SOURCE_DIR +
         "/share/eds/takt_drive402.eds, profile: cia402, tpdo: {1: {transmission: 1, cob_id: auto, "
         "mapping: [" +
         first[random.below(2)] + "]}, 2: {" +
         (second ? "transmission: 1, cob_id: auto, mapping: [{index: 0x606C}, {index: 0x6077}, "
                   "{index: 0x6061}]"
                 : "enabled: false") +
         "}, 3: {enabled: false}, 4: {enabled: false}}, rpdo: {1: {transmission: 1, cob_id: auto, "
         "mapping: [{index: 0x6040}, {index: 0x607A}]}, 2: {transmission: 1, cob_id: auto, "
         "mapping: [{index: 0x6060}]}, 3: {enabled: false}, 4: {enabled: false}}";
}

std::string io(sim::Random& random) {
  const auto n = std::to_string(1 + random.below(2));
  return std::string{"{dcf: "} + TAKT_SOURCE_DIR +
         "/share/eds/takt_io401.eds, tpdo: {1: {transmission: " + n +
         ", cob_id: auto}, 2: {transmission: 255, inhibit_time: " +
         std::to_string(50 + random.below(500)) + "}}, rpdo: {1: {transmission: 1, cob_id: auto}}";
}

/// Drives and inputs and outputs, on a bus between half full and full.
LoadedNetwork random_network(sim::Random& random) {
  static constexpr unsigned rates[] = {250, 500, 1000};
  const unsigned rate = rates[random.below(3)];
  const unsigned nodes = 1 + random.below(10);
  const unsigned us = (200 + nodes * 600) * 1000 / rate * (9 + random.below(12)) / 10;
  std::string text = "bus: {name: random, bitrate_kbit: " + std::to_string(rate) +
                     "}\nmaster: {sync_period: " + std::to_string(us) +
                     ", heartbeat_producer: " + std::to_string(40 + random.below(100)) +
                     "}\nnodes:\n";
  for (unsigned i = 1; i <= nodes; ++i) {
    text += "  n" + std::to_string(i) + ": " + (random.chance(0.7) ? drive(random) : io(random)) +
            ", node_id: " + std::to_string(3 * i) +
            ", heartbeat_producer: " + std::to_string(31 + random.below(90)) + "}\n";
  }
  const std::string path = testing::TempDir() + "takt_budget_random.yaml";
  std::ofstream{path} << text;
  return load_network(path);
}

/// Of the TPDOs of a node that follow SYNC.
Time bound_of(const BusBudget& budget, const std::string& node, bool emcys) {
  Time last{};
  for (const auto& row : budget.rows) {
    const bool its_own = row.frame.in_cycle && row.frame.kind == Traffic::tpdo &&
                         row.frame.name.ends_with(' ' + node);
    if (!its_own) continue;
    last = std::max(last, (emcys ? row.worst_in_burst : row.worst).value_or(Time::max()));
  }
  return last;
}

TEST(Budget, NoTpdoOfTheWholeMasterArrivesLaterThanItsBound) {
  unsigned judged = 0;
  for (unsigned round = 0; round < networks(); ++round) {
    sim::Random random{round};
    const auto network = random_network(random);
    if (has_error(network.findings)) continue;  // does not fit at all
    const auto budget = bus_budget(network.plan);

    const auto seen = simulate(network, {.duration = 1500ms, .seed = random.next(), .move = true});

    judged += seen.nodes.front().tpdo_frames > 0;
    for (const auto& node : seen.nodes) {
      EXPECT_LE(node.worst_tpdo, bound_of(budget, node.name, seen.emcy_frames != 0))
          << node.name << " of round " << round << ", EMCYs " << seen.emcy_frames;
    }
  }
  EXPECT_GT(judged, networks() / 2);
}

TEST(Budget, EveryDemoFits) {
  unsigned demos = 0;
  for (const auto& file : std::filesystem::directory_iterator{TAKT_SOURCE_DIR "/share/demo"}) {
    if (file.path().extension() != ".yaml") continue;
    EXPECT_TRUE(bus_budget(load_network(file.path()).plan).fits()) << file.path();
    ++demos;
  }
  EXPECT_GE(demos, 7U);
}

TEST(Budget, TheDemoOfSixteenNodesFitsButForChangesOfAllItsOutputsAtOnce) {
  const auto network = load_network(TAKT_SOURCE_DIR "/share/demo/sixteen_nodes.yaml");

  EXPECT_TRUE(bus_budget(network.plan).fits_but_for_changes());
}

TEST(Budget, TheDemoDoesNotFitAQuarterOfItsBitRate) {
  const auto network =
      load_changed_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml", {.bitrate_kbit = 250});

  EXPECT_FALSE(bus_budget(network.plan).fits());
}

}  // namespace
}  // namespace takt
