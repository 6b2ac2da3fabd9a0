// Programs that home axes under faults: no invariant is broken, and the judge finds the one that a
// test breaks.
#include "apps/takt/soak/homing_run.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <string>

#include "apps/takt/soak/judge/homing_judge.hpp"
#include "eds_parser/values/little_endian.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

class HomingRuns : public testing::Test {
 protected:
  const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/test/motions/data/homing.yaml");
};

TEST_F(HomingRuns, FaultsBreakNothing) {
  std::uint64_t homings = 0;
  std::uint64_t arrivals = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const SoakOutcome outcome = soak_homing(network, {.seed = seed, .duration = 40s});
    homings += outcome.homings;
    arrivals += outcome.arrivals;
    EXPECT_FALSE(outcome.violation)
        << fmt::format("seed {} at {} ms: {}: {}", seed, outcome.violation->when / 1ms,
                       outcome.violation->invariant, outcome.violation->what);
  }
  EXPECT_GT(homings, 20U);
  EXPECT_GT(arrivals, 10U);
}

TEST_F(HomingRuns, ADaemonThatDoesNotRequireHomingIsFound) {
  const FrontDefect forgets{.plan = [](BusPlan& plan) {
    for (NodePlan& node : plan.nodes) {
      for (auto& axis : node.axes) axis.homing.reset();
    }
  }};
  std::string what;
  for (std::uint64_t seed = 1; seed <= 6 && what.empty(); ++seed) {
    const SoakOutcome outcome =
        soak_homing(network, {.seed = seed, .duration = 20s, .front = forgets});
    if (outcome.violation) what = outcome.violation->invariant;
  }
  EXPECT_EQ(what, "no absolute motion without homing");
}

/// Gives frames of the shoulder to a judge, one after the other.
class HomingJudgeTest : public HomingRuns {
 protected:
  /// The TPDOs of a cycle with these values of the drive, and the RPDO with its next set-point.
  void cycle(std::uint16_t statusword, std::uint8_t mode, std::int32_t position,
             std::int32_t target) {
    now += network.plan.cycle.period;
    hear(0x181, little_endian(statusword, 2), little_endian(position, 4));
    hear(0x281, little_endian(0, 4), little_endian(mode, 1));
    hear(0x201, little_endian(0x0F, 2), little_endian(target, 4));
  }
  void boot_up() {
    now += network.plan.cycle.period;
    hear(0x701, little_endian(0, 1), {});
  }
  void report_homed() {
    axis_motion_t shoulder{};
    shoulder.node_id = 1;
    shoulder.axis = 1;
    shoulder.homing = 2;
    motion_t motions{};
    motions.axes = {shoulder};
    now += 100ms;
    judge.reported(motions, now);
  }
  std::string violated() const { return verdict.good() ? "" : verdict.violation()->invariant; }

  static constexpr std::uint16_t enabled = 0x0237;
  static constexpr std::uint16_t homed = 0x1637;
  Verdict verdict;
  HomingJudge judge{network.plan, verdict, 3.0};

 private:
  void hear(std::uint32_t id, std::vector<std::byte> first, const std::vector<std::byte>& second) {
    first.insert(first.end(), second.begin(), second.end());
    Frame frame{.id = CobId::base(id), .length = static_cast<std::uint8_t>(first.size())};
    std::ranges::transform(first, frame.data.begin(),
                           [](std::byte one) { return std::to_integer<std::uint8_t>(one); });
    judge.heard(frame, now);
  }
  Time now = 1s;
};

TEST_F(HomingJudgeTest, ARunThatEndsWellIsNoViolation) {
  cycle(enabled, 8, 0, 0);
  for (int i = 0; i < 5; ++i) cycle(enabled, 6, 10 * i, 10 * i);
  cycle(homed, 6, 796, 50);
  cycle(homed, 6, 796, 796);
  cycle(enabled, 8, 796, 800);
  report_homed();
  EXPECT_EQ(violated(), "");
  EXPECT_EQ(judge.runs(), 1U);
  EXPECT_EQ(judge.changes(), 1U);
}

TEST_F(HomingJudgeTest, ASetPointFromBeforeTheRunIsAJump) {
  cycle(enabled, 6, 0, 0);
  cycle(homed, 6, 796, 0);
  cycle(enabled, 8, 796, 0);
  EXPECT_EQ(violated(), "no set-point jumps");
}

TEST_F(HomingJudgeTest, AnAxisWithoutARunIsNotHomed) {
  cycle(enabled, 8, 0, 0);
  report_homed();
  EXPECT_EQ(violated(), "an axis is homed only after a good run");
}

TEST_F(HomingJudgeTest, ANodeThatBootsIsNotHomed) {
  cycle(homed, 6, 0, 0);
  report_homed();
  EXPECT_EQ(violated(), "");
  boot_up();
  report_homed();
  EXPECT_EQ(violated(), "an axis is homed only after a good run");
}

}  // namespace
}  // namespace takt::soak
