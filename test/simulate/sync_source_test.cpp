#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>

#include "apps/takt/simulate/simulation.hpp"
#include "test/support/folder.hpp"

// A device produces SYNC, and the master's cycle follows this SYNC.

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr std::uint8_t producer = 3;

LoadedNetwork demo() { return load_network(TAKT_SOURCE_DIR "/share/demo/lenze8400_sync.yaml"); }

sim::Fault drift(int ppm) {
  return {.kind = sim::FaultKind::drift, .node = NodeId::from(producer), .ppm = ppm};
}

sim::Fault without_power(Time from, Time until) {
  return {.kind = sim::FaultKind::power_off,
          .node = NodeId::from(producer),
          .at = from,
          .until = until};
}

long count(const SimulationOutcome& outcome, EventKind kind) {
  return std::ranges::count(outcome.events, kind, &ReportedEvent::kind);
}

std::string text_of(const SimulationOutcome& outcome, EventKind kind) {
  const auto found = std::ranges::find(outcome.events, kind, &ReportedEvent::kind);
  return found == outcome.events.end() ? "" : found->text;
}

/// Times in microseconds from SYNC (0x080) to RPDO1 of the axis (0x205), for all frames after the
/// first two seconds of a candump log.
struct Offsets {
  long least = 1'000'000;
  long most = 0;
  long frames = 0;
  long syncs = 0;
};

Offsets offsets_of(const std::filesystem::path& log) {
  Offsets offsets;
  std::ifstream in{log};
  double sync = 0;
  double first = -1;
  for (std::string line; std::getline(in, line);) {
    const double when = std::stod(line.substr(1));
    if (first < 0) first = when;
    const std::size_t id = line.rfind(' ') + 1;
    if (when - first < 2) continue;
    if (line.compare(id, 4, "080#") == 0) {
      sync = when;
      ++offsets.syncs;
    }
    if (line.compare(id, 4, "205#") != 0 || sync == 0) continue;
    const long us = std::lround((when - sync) * 1e6);
    offsets.least = std::min(offsets.least, us);
    offsets.most = std::max(offsets.most, us);
    ++offsets.frames;
  }
  return offsets;
}

class Drift : public testing::TestWithParam<int> {};

TEST_P(Drift, OfTheProducersClockMovesNoOutputAgainstItsSync) {
  const test::Folder folder;
  const auto log = folder / "log";
  const auto outcome = simulate(
      demo(),
      {.duration = 100s, .faults = {drift(GetParam())}, .move = true, .candump = log.string()});
  const Offsets offsets = offsets_of(log);

  EXPECT_TRUE(outcome.stopped);
  EXPECT_EQ(outcome.axes_moved, 1u);
  EXPECT_EQ(count(outcome, EventKind::sync_back), 1);  // the first one
  EXPECT_EQ(count(outcome, EventKind::sync_lost), 0);
  EXPECT_EQ(outcome.sync.gaps, 0u);
  for (const NodeOutcome& node : outcome.nodes) {
    EXPECT_EQ(node.boot_failures, 0u) << node.name;
    EXPECT_EQ(node.tpdo_missing, 0u) << node.name;
  }
  // 200 ppm of 98 s are 19.6 ms or two periods, so a free-running cycle would have drifted through
  // all offsets.
  EXPECT_GT(offsets.syncs, 9700);
  EXPECT_GT(offsets.frames, 9700);
  EXPECT_LT(offsets.most - offsets.least, 300) << "one frame of 0.27 ms may be before it";
}

INSTANTIATE_TEST_SUITE_P(Ppm, Drift, testing::Values(-200, 0, 200));

TEST(SyncSource, ReportsALostSyncAndFallsBack) {
  const auto outcome =
      simulate(demo(), {.duration = 8s, .faults = {without_power(5s, 6s)}, .move = true});

  ASSERT_EQ(count(outcome, EventKind::sync_lost), 1);
  const std::string lost = text_of(outcome, EventKind::sync_lost);
  EXPECT_NE(lost.find("SYNC lost: no SYNC for 15"), std::string::npos) << lost;
  EXPECT_NE(lost.find("outputs take their fallback"), std::string::npos) << lost;
  EXPECT_NE(lost.find("node 3"), std::string::npos) << lost;
  EXPECT_EQ(count(outcome, EventKind::sync_back), 2) << "the first one, and after the loss";
  EXPECT_TRUE(outcome.stopped);
}

/// Returns the time of the first frame that starts with `frame`, from the time `from` of a candump
/// log on; 0 if there is none.
double first_frame(const std::filesystem::path& log, const std::string& frame, double from) {
  std::ifstream in{log};
  for (std::string line; std::getline(in, line);) {
    const double when = std::stod(line.substr(1));
    const std::size_t id = line.rfind(' ') + 1;
    if (when >= from && line.compare(id, frame.size(), frame) == 0) return when;
  }
  return 0;
}

TEST(SyncSource, ThatIsLostMakesTheFallbackOfSynchronousOutputsActAtOnce) {
  const test::Folder folder;
  const auto log = folder / "log";
  const auto outcome = simulate(demo(), {.duration = 8s,
                                         .faults = {without_power(5s, 6500ms)},
                                         .move = true,
                                         .candump = log.string()});
  const double written = first_frame(log, "605#2B40600002000000", 5);  // 6040 = quick stop
  const double confirmed = first_frame(log, "585#6040600000000000", 5);
  const double sync = first_frame(log, "080#", 5.1);

  EXPECT_GT(written, 5.0);
  EXPECT_LT(written, 5.1) << "not only when SYNC is back";
  EXPECT_GT(confirmed, written);
  EXPECT_LT(confirmed, written + 0.005);
  EXPECT_GT(sync, 6.4);
  EXPECT_TRUE(outcome.stopped);
  EXPECT_EQ(outcome.loop.sync_losses, 1u);
  EXPECT_EQ(outcome.loop.sync, SyncState::locked);
}

TEST(SyncSource, ThatStopsTheNodesStartsThemAgain) {
  LoadedNetwork network = demo();
  network.plan.cycle.on_sync_loss = SyncLoss::stop;

  const auto outcome = simulate(network, {.duration = 8s, .faults = {without_power(5s, 6s)}});

  EXPECT_NE(text_of(outcome, EventKind::sync_lost).find("is stopped"), std::string::npos);
  const auto axis_is = [&](Time from, const std::string& state) {
    return std::ranges::any_of(outcome.events, [&](const ReportedEvent& event) {
      return event.kind == EventKind::node_state && event.node == 5 && event.when > from &&
             event.text.find(state) != std::string::npos;
    });
  };
  EXPECT_TRUE(axis_is(5s, "STOPPED"));
  EXPECT_TRUE(axis_is(6s, "OPERATIONAL"));
  EXPECT_EQ(outcome.nodes.at(1).status.boot_count, 1u) << "it is started, not booted again";
}

TEST(SyncSource, ThatIsNeverThereIsReported) {
  LoadedNetwork network = demo();
  network.plan.cycle.sync_producer.reset();
  for (BootStep& step : network.plan.nodes.at(0).boot_plan.steps) {
    if (step.object == ObjectKey{0x1005, 0}) step.value.back() = std::byte{0};  // no bit 30
  }

  const auto outcome = simulate(network, {.duration = 5s});

  EXPECT_EQ(outcome.sync.count, 0u);
  ASSERT_EQ(count(outcome, EventKind::sync_lost), 1);
  EXPECT_NE(text_of(outcome, EventKind::sync_lost).find("no SYNC has come"), std::string::npos);
  for (const NodeOutcome& node : outcome.nodes) {
    EXPECT_TRUE(node.first_boot.has_value()) << node.name << ": services go on without SYNC";
  }
  EXPECT_TRUE(outcome.stopped);
}

}  // namespace
}  // namespace takt
