#include "eds_parser/budget/budget.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>

#include "apps/takt/simulate/simulation.hpp"
#include "eds_parser/network_file/changed_network.hpp"
#include "test/simulate/loaded_run.hpp"
#include "test/simulate/random_network.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// Number of random networks; TAKT_BUDGET_NETWORKS=5000 replaces the default.
unsigned networks() {
  const char* text = std::getenv("TAKT_BUDGET_NETWORKS");
  return text == nullptr ? 60 : static_cast<unsigned>(std::strtoul(text, nullptr, 10));
}

/// Returns the bound of the TPDOs of a node that follow SYNC.
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
    if (has_error(network.findings)) continue;  // the traffic does not fit the bus
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

TEST(Budget, NothingOfTheCycleIsLaterThanItsBoundWhileServersAnswerLate) {
  unsigned judged = 0;
  std::uint64_t answers = 0;
  for (unsigned round = 0; round < networks(); ++round) {
    sim::Random random{round};
    const auto network = random_network(random);
    if (has_error(network.findings)) continue;
    const auto budget = bus_budget(network.plan);
    const Time slowest = 1ms * (1 + random.below(20));

    const auto seen = run_loaded(network, budget, 1500ms, slowest, random.next());

    answers += seen.sdo_answers;
    for (std::size_t i = 0; i < seen.worst.size(); ++i) {
      if (!budget.rows[i].worst) continue;
      EXPECT_LE(seen.worst[i], *budget.rows[i].worst)
          << budget.rows[i].frame.name << " of round " << round << ", " << seen.late_syncs;
      ++judged;
    }
  }
  EXPECT_GT(judged, networks());
  EXPECT_GT(answers, 100 * networks());
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
