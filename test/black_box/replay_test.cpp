#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <sstream>

#include "test/black_box/recorded_run.hpp"
#include "test/support/folder.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::Folder;
using test::RecordedRun;
using test::replay_file;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

void overwrite(const std::filesystem::path& path, const std::string& text) {
  std::ofstream{path, std::ios::binary | std::ios::trunc} << text;
}

/// Faults of two nodes: one is lost and comes back, the other resets. Commands and requests
/// continue meanwhile.
sim::Faults bad_day() {
  return {{.kind = sim::FaultKind::power_off, .node = 1_node, .at = 1500ms, .until = 2200ms},
          {.kind = sim::FaultKind::loss, .at = 2500ms, .until = 2600ms, .probability = 0.3},
          {.kind = sim::FaultKind::reset, .node = 2_node, .at = 3s},
          {.kind = sim::FaultKind::device_error, .node = 2_node, .at = 1200ms, .emcy_code = 0x3210},
          {.kind = sim::FaultKind::bus_off, .at = 3800ms}};
}

/// Set-points in each cycle, now and then an SDO request.
void keep_busy(RecordedRun& run) {
  run.each_cycle = [&run, n = 0]() mutable {
    Exchange& exchange = *run.exchange;
    const std::size_t outputs = run.network.plan.layout.outputs();
    if (++n % 3 != 0) {
      for (std::size_t i = 0; i < outputs; ++i) exchange.set_points.set(i, 6 + n % 2, 50);
      exchange.set_points.publish(run.world.now());
    }
    if (n % 40 == 0) {
      exchange.requests.push({.id = static_cast<std::uint64_t>(n),
                              .kind = RequestKind::sdo_upload,
                              .node = static_cast<std::uint8_t>(1 + n / 40 % 2),
                              .object = {0x1008, 0}});
    }
  };
}

TEST(Replay, TakesTheSameDecisionsThroughFaultsCommandsAndRequests) {
  const Folder folder;
  RecordedRun run{"two_axes.yaml", bad_day()};
  keep_busy(run);
  run.run_until(5s);
  run.stop();
  run.write_tape(folder / "bad", run.journal.last());

  const auto outcome = replay_file(run.network.plan, folder / "bad.log");

  EXPECT_FALSE(outcome.difference) << *outcome.difference;
  EXPECT_EQ(outcome.decisions, run.events.size());
  EXPECT_GT(run.replies.size(), 30U);
  const auto seen = [&](EventKind kind) {
    return std::ranges::count(run.events, kind, &Event::kind);
  };
  EXPECT_GE(seen(EventKind::boot_done), 4);
  EXPECT_GE(seen(EventKind::heartbeat_lost), 1);
  EXPECT_GE(seen(EventKind::emcy), 1);
  EXPECT_GE(seen(EventKind::bus_off), 1);
  EXPECT_EQ(seen(EventKind::stopped), 1);
}

TEST(Recording, LeavesTheLimitsOfAnEnabledAxisAsTheyAre) {
  RecordedRun run{"two_axes.yaml"};
  const ImageLayout& layout = run.network.plan.layout;
  std::int64_t controlword = 6;
  std::int64_t position = 0;
  run.each_cycle = [&] {
    Exchange& exchange = *run.exchange;
    for (std::size_t i = 0; i < layout.outputs(); ++i) {
      const std::uint16_t object = layout.signals[layout.inputs + i].object.index;
      if (object == 0x6060) exchange.set_points.set(i, 8, 50);
      if (object == 0x6040) exchange.set_points.set(i, controlword, 50);
      if (object == 0x607A) exchange.set_points.set(i, position, 50);
    }
    exchange.set_points.publish(run.world.now());
  };
  run.run_until(1s);
  for (const std::int64_t step : {6, 7, 15}) {
    controlword = step;
    run.run_until(run.world.now() + 200ms);
  }
  for (const Time end = run.world.now() + 2s; run.world.now() < end; run.cycle()) position += 20;

  EXPECT_EQ(std::ranges::count(run.events, EventKind::limit_exceeded, &Event::kind), 0)
      << "`acceleration` is not limited";
}

TEST(Replay, OfARunningMasterEndsWhereTheTapeWasTaken) {
  const Folder folder;
  RecordedRun run{"two_axes.yaml"};
  run.run_until(1s);
  const auto file = run.write(folder / "calm");
  run.run_until(1200ms);

  const auto outcome = replay_file(run.network.plan, file);

  EXPECT_FALSE(outcome.difference) << *outcome.difference;
  EXPECT_GT(outcome.cycles, 450U);
}

TEST(Replay, NamesTheFrameThatAChangedLogMakesTheMasterSend) {
  const Folder folder;
  RecordedRun run{"two_axes.yaml"};
  run.run_until(1s);
  run.write(folder / "calm");
  std::string log = text_of(folder / "calm.log");
  const std::size_t answer = log.find(" 581#43181001CDAB0000");  // vendor id 0x0000ABCD
  ASSERT_NE(answer, std::string::npos);
  log.replace(answer, 21, " 581#43181001CEAB0000");
  overwrite(folder / "calm.log", log);

  const auto outcome = replay_file(run.network.plan, folder / "calm.events.json");

  ASSERT_TRUE(outcome.difference);
  EXPECT_NE(outcome.difference->find("cycle "), std::string::npos) << *outcome.difference;
  EXPECT_NE(outcome.difference->find("failed to boot"), std::string::npos) << *outcome.difference;
}

TEST(Replay, NamesTheDecisionThatWasWrittenDifferently) {
  const Folder folder;
  RecordedRun run{"two_axes.yaml"};
  run.run_until(1s);
  run.write(folder / "calm");
  std::string events = text_of(folder / "calm.events.json");
  const std::size_t at = events.find("\"boot_done\"");
  ASSERT_NE(at, std::string::npos);
  events.replace(at, 11, "\"boot_dune\"");
  overwrite(folder / "calm.events.json", events);

  const auto outcome = replay_file(run.network.plan, folder / "calm.journal");

  ASSERT_TRUE(outcome.difference);
  EXPECT_NE(outcome.difference->find("in the recording with other details"), std::string::npos)
      << *outcome.difference;
}

TEST(Replay, OfAnotherPlanNamesWhatItChanges) {
  const Folder folder;
  RecordedRun run{"two_axes.yaml"};
  run.run_until(1s);
  run.write(folder / "calm");
  BusPlan plan = run.network.plan;
  plan.master_heartbeat = {};

  const auto outcome = replay_file(plan, folder / "calm");

  ASSERT_TRUE(outcome.difference);
  EXPECT_NE(outcome.difference->find("the master "), std::string::npos) << *outcome.difference;
}

TEST(Replay, GoesThroughRecordingsThatFollowOneAnother) {
  const Folder folder;
  RecordedRun run{"two_axes.yaml", bad_day()};
  keep_busy(run);
  run.run_until(1s);
  run.write(folder / "first");
  run.run_until(2s);
  run.write(folder / "second", "first");
  run.run_until(4s);
  run.stop();
  run.write_tape(folder / "third", run.journal.last(), "second");

  const auto third = read_recording(folder / "third");
  const auto outcome = replay_file(run.network.plan, folder / "third.log");

  ASSERT_TRUE(third);
  EXPECT_EQ(third->parts.size(), 3U);
  EXPECT_FALSE(outcome.difference) << *outcome.difference;
  EXPECT_EQ(outcome.decisions, run.events.size());
}

TEST(Replay, WithoutTheBeginningOfTheRunBeginsWithACheckpoint) {
  const Folder folder;
  RecordedRun run{"two_axes.yaml", bad_day()};
  run.run_until(1s);
  run.write(folder / "first");
  run.run_until(1500ms);
  run.write(folder / "second", "first");
  run.run_until(3s);
  run.write(folder / "third", "second");
  std::filesystem::remove(folder / "first.journal");

  const auto third = read_recording(folder / "third");
  const auto outcome = replay_file(run.network.plan, folder / "third");

  ASSERT_TRUE(third);
  EXPECT_EQ(third->parts.size(), 2U) << "the second too, from its checkpoint on";
  EXPECT_FALSE(third->head.from_start);
  EXPECT_FALSE(outcome.difference) << *outcome.difference;
  EXPECT_GT(outcome.cycles, 950U);
}

TEST(Replay, OfARunMuchLongerThanTheTapeTakesTheSameDecisions) {
  const Folder folder;
  sim::Faults faults = bad_day();
  for (sim::Fault& fault : faults) {
    fault.at += 57s;
    if (fault.until != never) fault.until += 57s;
  }
  RecordedRun run{"two_axes.yaml", faults, 1 << 20};
  keep_busy(run);
  run.run_until(61s);
  run.stop();
  run.write_tape(folder / "ring", run.journal.last());

  const auto recording = read_recording(folder / "ring");
  const auto outcome = replay_file(run.network.plan, folder / "ring.log");

  ASSERT_TRUE(recording);
  EXPECT_FALSE(recording->head.from_start);
  EXPECT_FALSE(outcome.difference) << *outcome.difference;
  EXPECT_EQ(outcome.decisions, recording->decisions.size());
  const auto seen = [&](const std::string& kind) {
    return std::ranges::count(recording->decisions, kind, &Decision::kind);
  };
  EXPECT_GE(seen("heartbeat_lost"), 1);
  EXPECT_GE(seen("boot_done"), 2);
  EXPECT_EQ(seen("stopped"), 1);
}

TEST(Replay, WithoutStartAndCheckpointIsRefusedWithTheReason) {
  const Folder folder;
  RecordedRun run{"two_axes.yaml", {}, 64 << 10};  // too small for a checkpoint
  run.run_until(6s);
  run.write(folder / "ring");

  const auto recording = read_recording(folder / "ring");

  ASSERT_TRUE(recording);
  ASSERT_TRUE(recording->fault);
  EXPECT_NE(recording->fault->find("the recording begins in the middle of the run"),
            std::string::npos);
  EXPECT_GT(recording->parts.front().frames.size(), 200U);
}

TEST(Replay, FromTheMiddleOfARunOfAnotherNetworkIsRefused) {
  const Folder folder;
  RecordedRun run{"two_axes.yaml", {}, 512 << 10};
  run.run_until(20s);
  run.write(folder / "ring");

  const auto outcome =
      replay_file(load_network(TAKT_SOURCE_DIR "/share/demo/beckhoff.yaml").plan, folder / "ring");

  ASSERT_TRUE(outcome.difference);
  EXPECT_NE(outcome.difference->find("other nodes or PDOs"), std::string::npos);
}

/// Random faults of all these kinds, at any time of eight seconds.
sim::Faults any_day(const BusPlan& plan, std::uint64_t seed) {
  using enum sim::FaultKind;
  constexpr std::array kinds{power_off,    loss,           delay,  mute_sdo, no_heartbeat,
                             bootup_storm, mute_pdo,       reset,  bus_off,  device_error,
                             stall_master, interface_down, babble, no_start};
  std::mt19937_64 random{seed};
  const auto up_to = [&](std::int64_t most) {
    return Time{static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(most))};
  };
  sim::Faults faults;
  for (int i = 0; i < 12; ++i) {
    const Time at = up_to(Time{8s}.count());
    faults.push_back({.kind = kinds[random() % kinds.size()],
                      .node = plan.nodes[random() % plan.nodes.size()].id,
                      .at = at,
                      .until = at + up_to(Time{400ms}.count()),
                      .probability = 0.2,
                      .time = 5ms + up_to(Time{100ms}.count()),
                      .cob_id = CobId::base(0x180 + static_cast<std::uint32_t>(random() % 0x500)),
                      .emcy_code = 0x3210});
    if (faults.back().kind == bus_off || faults.back().kind == stall_master)
      faults.back().node = {};
  }
  return faults;
}

/// A replay from each checkpoint must give the same result as a replay from the start.
void expect_each_checkpoint_leads_to_the_same(RecordedRun& run) {
  const Folder folder;
  keep_busy(run);
  run.run_until(9s);
  run.stop();
  run.write_tape(folder / "run", run.journal.last());
  auto recording = read_recording(folder / "run");
  ASSERT_TRUE(recording) << recording.error();
  ASSERT_FALSE(recording->fault) << *recording->fault;
  ASSERT_TRUE(recording->head.from_start);

  int checkpoints = 0;
  while (begin_with_checkpoint(*recording)) {
    const auto outcome = replay(run.network.plan, *recording, [](const Decision&) {});
    ASSERT_FALSE(outcome.difference) << "checkpoint " << checkpoints << ", then " << outcome.cycles
                                     << " cycles: " << *outcome.difference;
    ASSERT_EQ(outcome.decisions, recording->decisions.size());
    ++checkpoints;
  }
  EXPECT_GT(checkpoints, 2);
}

class EachCheckpoint : public testing::TestWithParam<std::pair<std::string, std::size_t>> {};

TEST_P(EachCheckpoint, LeadsToTheSameDecisions) {
  const auto& [name, kilobytes] = GetParam();
  RecordedRun run{name + ".yaml", bad_day(), kilobytes << 10};
  expect_each_checkpoint_leads_to_the_same(run);
}

INSTANTIATE_TEST_SUITE_P(Demos, EachCheckpoint,
                         testing::Values(std::pair{"two_axes", 4096},
                                         std::pair{"sixteen_nodes", 4096},
                                         std::pair{"lenze8400", 1024},
                                         std::pair{"lenze8400_sync", 1024},
                                         std::pair{"beckhoff", 1024}, std::pair{"plain301", 1024},
                                         std::pair{"astraada_drv28", 1024}));

/// TAKT_REPLAY_SEEDS=500 runs 500 seeds instead of 8.
TEST(Replay, FromEachCheckpointOfAnyDayTakesTheSameDecisions) {
  const char* const wanted = std::getenv("TAKT_REPLAY_SEEDS");
  const int seeds = wanted != nullptr ? std::atoi(wanted) : 8;
  for (int seed = 1; seed <= seeds && !HasFatalFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::string network = seed % 2 == 0 ? "two_axes.yaml" : "sixteen_nodes.yaml";
    const BusPlan plan = load_network(TAKT_SOURCE_DIR "/share/demo/" + network).plan;
    RecordedRun run{network, any_day(plan, static_cast<std::uint64_t>(seed)), 4 << 20};
    expect_each_checkpoint_leads_to_the_same(run);
  }
}

}  // namespace
}  // namespace takt
