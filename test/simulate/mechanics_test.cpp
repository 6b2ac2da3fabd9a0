#include <gtest/gtest.h>
#include <sstream>

#include "apps/takt/simulate/outcome_report.hpp"
#include "apps/takt/simulate/simulation.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

SimulationOutcome moved(std::uint64_t seed) {
  static const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/mechanics.yaml");
  return simulate(network, {.duration = 4s, .seed = seed, .move = true});
}

std::string json(std::uint64_t seed) {
  std::ostringstream text;
  print_json(text, moved(seed));
  return text.str();
}

TEST(Mechanics, MoveWithoutAFault) {
  const auto outcome = moved(1);

  EXPECT_TRUE(outcome.stopped);
  EXPECT_EQ(outcome.axes_moved, 2u);
  for (const NodeOutcome& node : outcome.nodes) {
    EXPECT_EQ(node.status.emcy_count, 0u) << node.name;
    EXPECT_EQ(node.tpdo_missing, 0u) << node.name;
  }
}

TEST(Mechanics, GiveTheSameRunForTheSameSeed) { EXPECT_EQ(json(7), json(7)); }

}  // namespace
}  // namespace takt
