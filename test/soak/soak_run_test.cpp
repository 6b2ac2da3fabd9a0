#include "apps/takt/soak/soak_run.hpp"

#include <array>
#include <csignal>
#include <gtest/gtest.h>
#include <malloc.h>
#include <memory>
#include <vector>

#include "apps/takt/soak/soak_jobs.hpp"
#include "master/rt/exchange/exchange.hpp"
#include "master/sim/bus/world.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

LoadedNetwork demo() { return load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml"); }

TEST(Soak, GivesTheSameRunForTheSameSeed) {
  const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");

  const SoakOutcome first = soak(network, {.seed = 5, .duration = 3s});
  const SoakOutcome again = soak(network, {.seed = 5, .duration = 3s});
  const SoakOutcome other = soak(network, {.seed = 6, .duration = 3s});

  EXPECT_FALSE(first.violation);
  EXPECT_EQ(first.frames, again.frames);
  EXPECT_EQ(first.events, again.events);
  EXPECT_EQ(first.simulated, again.simulated);
  EXPECT_NE(first.frames, other.frames);
}

/// Regression: after a stall without SYNC, the time stamp of a cycle was a SYNC in the future.
TEST(Soak, HoldsWhereAnotherDeviceMakesTheSync) {
  const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/lenze8400_sync.yaml");

  for (std::uint64_t seed = 7030; seed <= 7040; ++seed) {
    const SoakOutcome outcome = soak(network, {.seed = seed, .duration = 20s});
    EXPECT_FALSE(outcome.violation) << seed;
  }
}

/// Complete runs in which one part is broken. They show that each judge is connected and reports
/// its invariant.
class Defects : public testing::Test {
 protected:
  using Defect = std::function<void(Exchange&, sim::World&)>;

  /// Returns the invariant that the run breaks; empty if it breaks none.
  std::string broken(Defect defect, Time duration = 2s) {
    const SoakOutcome outcome =
        soak(network, {.seed = 5, .duration = duration, .defect = std::move(defect)});
    return outcome.violation ? outcome.violation->invariant : "";
  }
  /// Publishes one more image, once, as soon as images come.
  void publish(Exchange& exchange, ImageStamp stamp) {
    if (done_) return;
    done_ = true;
    const std::vector<std::int64_t> values(network.plan.layout.signals.size(), 0x5A5A);
    const std::vector<std::uint64_t> stale((values.size() + 63) / 64, 0);
    const std::vector<PdoMark> marks(network.plan.pdos.tpdos.size());
    exchange.images.publish(stamp, values, stale, marks);
  }
  static std::uint64_t cycle(const Exchange& exchange) {
    StatusSnapshot status;
    exchange.status.read(status);
    return status.bus.cycle;
  }

  LoadedNetwork network = demo();

 private:
  bool done_ = false;
};

TEST_F(Defects, NotAtAllBreaksNothing) {
  EXPECT_EQ(broken([](Exchange&, sim::World&) {}), "");
}

TEST_F(Defects, ImageIsTorn) {
  const auto defect = [this](Exchange& exchange, sim::World& world) {
    if (world.now() < 2s) return;
    publish(
        exchange,
        {.cycle = cycle(exchange) + 100, .sync_time = world.now(), .publish_time = world.now()});
  };
  EXPECT_EQ(broken(defect), "no torn image");
}

TEST_F(Defects, CycleNumberComesAgain) {
  const auto defect = [this](Exchange& exchange, sim::World& world) {
    if (world.now() < 2s) return;
    publish(exchange, {.cycle = 1, .sync_time = world.now(), .publish_time = world.now()});
  };
  EXPECT_EQ(broken(defect), "cycle numbers rise");
}

/// Another writer keeps the axes enabled while their application is silent.
TEST_F(Defects, OutputOutlivesItsCommand) {
  const auto defect = [this](Exchange& exchange, sim::World& world) {
    const ImageLayout& layout = network.plan.layout;
    for (std::size_t i = layout.inputs; i < layout.signals.size(); ++i) {
      if (layout.signals[i].object.index != 0x6040) continue;
      exchange.set_points.set(i - layout.inputs, 0x0F, 100'000);
    }
    exchange.set_points.publish(world.now());
  };
  EXPECT_EQ(broken(defect, 10s), "no stale output");
}

TEST_F(Defects, ReplyComesTwice) {
  const auto defect = [sent = false](Exchange& exchange, sim::World& world) mutable {
    if (world.now() < 2s || sent) return;
    sent = exchange.replies.push({.id = 1});
  };
  EXPECT_EQ(broken(defect), "every request is answered once");
}

TEST_F(Defects, ReplyIsLost) {
  const auto defect = [lost = false](Exchange& exchange, sim::World&) mutable {
    Reply reply;
    if (!lost) lost = exchange.replies.pop(reply);
  };
  EXPECT_EQ(broken(defect), "every request is answered once");
}

TEST_F(Defects, NodeIsInAStateWithoutName) {
  const auto defect = [](Exchange& exchange, sim::World& world) {
    if (world.now() < 2s) return;
    StatusSnapshot status;
    exchange.status.read(status);
    status.nodes[0].nmt = static_cast<NmtState>(0x42);
    exchange.status.write(
        status.bus, status.nodes, [&](std::size_t i) { return status.tpdos[i]; },
        [&](std::size_t i) { return status.rpdos[i]; });
  };
  EXPECT_EQ(broken(defect), "every node is in a named state");
}

TEST_F(Defects, NodeStaysAway) {
  const auto defect = [](Exchange&, sim::World& world) {
    if (world.now() > 3s) world.power(1_node, false);
  };
  EXPECT_EQ(broken(defect), "every node comes back");
}

TEST_F(Defects, MemoryGrows) {
  std::vector<std::unique_ptr<std::array<char, 1024>>> leak;
  const auto add = [&leak] { leak.push_back(std::make_unique<std::array<char, 1024>>()); };
  const std::size_t before = ::mallinfo2().uordblks;
  for (int i = 0; i < 100; ++i) add();
  if (::mallinfo2().uordblks < before + 100 * 1024) GTEST_SKIP() << "a heap that is not glibc's";

  EXPECT_EQ(broken([&](Exchange&, sim::World&) { add(); }), "memory stays flat");
}

TEST_F(Defects, StopTakesLongerThanThePlanAllows) {
  const auto defect = [this](Exchange&, sim::World&) { network.plan.stop_timeout = Time{}; };
  EXPECT_EQ(broken(defect), "the ordered stop ends in time");
}

TEST(SoakJobs, ReportTheSeedOfAViolationAndOfACrash) {
  const LoadedNetwork network = demo();
  SoakPlan plan{.first = 1, .last = 4, .jobs = 2, .run = {.duration = 500ms}};
  std::vector<SoakReport> reports;
  plan.run.defect = [](Exchange& exchange, sim::World& world) {
    if (world.now() > 1s) exchange.replies.push({.id = 1'000'000});
  };
  run_jobs(network, plan, [&](const SoakReport& report) { reports.push_back(report); });
  ASSERT_EQ(reports.size(), 4U);
  std::uint64_t seeds = 0;
  for (const SoakReport& report : reports) {
    ASSERT_TRUE(report.outcome.violation);
    EXPECT_EQ(report.outcome.violation->invariant, "every request is answered once");
    EXPECT_EQ(report.outcome.violation->what, "request 1000000 is answered again");
    EXPECT_GE(report.outcome.violation->when, 1s);
    seeds += report.outcome.seed;
  }
  EXPECT_EQ(seeds, 1U + 2U + 3U + 4U);

  reports.clear();
  plan.run.defect = [](Exchange&, sim::World& world) {
    if (world.now() > 1s) std::raise(SIGKILL);
  };
  run_jobs(network, plan, [&](const SoakReport& report) { reports.push_back(report); });
  ASSERT_EQ(reports.size(), 2U) << "one of each worker";
  EXPECT_EQ(reports[0].outcome.seed, 1U);
  EXPECT_EQ(reports[0].signal, SIGKILL);
  EXPECT_EQ(reports[1].outcome.seed, 2U);
  EXPECT_EQ(reports[1].signal, SIGKILL);
}

}  // namespace
}  // namespace takt::soak
