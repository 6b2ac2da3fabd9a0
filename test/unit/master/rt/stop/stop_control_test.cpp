#include "master/rt/stop/stop_control.hpp"

#include <gtest/gtest.h>
#include <memory>
#include <utility>
#include <vector>

#include "master/core/kept_state.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"
#include "test/unit/master/rt/fake_port.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::FakeNetwork;
using test::FakePort;

constexpr std::int64_t quick_stop = 0x02;
constexpr std::int64_t disable_voltage = 0x00;
constexpr std::int64_t enable_operation = 0x0F;

/// Two axes that are enabled, exchange PDOs and are commanded.
struct StopControlTest : testing::Test {
  explicit StopControlTest(BusPlan bus_plan = test::axes()) : plan{std::move(bus_plan)} {
    const std::vector<SetPoint> no_commands(plan.layout.outputs());
    for (std::size_t node = 0; node < 2; ++node) {
      bus.exchanging[node] = true;
      bus.pdos.inputs().set_reception(node, Reception::full);
      bus.pdos.outputs().open(node, no_commands);
    }
    command_all();
    cycle();
  }
  void command_all() {
    for (SignalIndex signal = 4; signal < 8; ++signal) {
      bus.pdos.outputs().command(signal, enable_operation, 1000, {.cycle = beat, .now = now});
    }
  }
  /// Receives the statuswords and advances the stops by one cycle of 2 ms.
  void cycle() {
    now += 2ms;
    bus.pdos.inputs().begin(++beat, now);
    for (std::uint32_t node = 0; node < 2; ++node) {
      const Frame tpdo = make_frame(CobId::base(0x181 + node), {statusword, 0x02, 0, 0, 0, 0});
      bus.pdos.inputs().receive({.frame = tpdo, .when = now});
    }
    bus.pdos.inputs().close(now);
    stop.end_halt();
    stop.submit_requests(port);
    stop.step(front, now);
    stop.stop_after_loss();
    bus.pdos.inputs().forget_marks();
  }
  std::int64_t controlword(std::size_t axis) const { return bus.pdos.image().values[4 + axis]; }

  BusPlan plan;
  std::uint8_t statusword = 0x27;  // "operation enabled"
  Time now = 10s;
  std::uint64_t beat = 0;
  FakePort port;
  std::unique_ptr<Exchange> exchange = std::make_unique<Exchange>(plan);
  DirectLink front{*exchange};
  std::unique_ptr<BusMachines<FakeNetwork>> machines =
      std::make_unique<BusMachines<FakeNetwork>>(plan, false);
  BusMachines<FakeNetwork>& bus = *machines;
  StopControl<FakeNetwork> stop{bus};
};

TEST_F(StopControlTest, LeavesTheAxesToTheirCommandsWithoutAReason) {
  EXPECT_EQ(controlword(0), enable_operation);
  EXPECT_TRUE(stop.idle());
  EXPECT_FALSE(stop.done());
  EXPECT_FALSE(stop.withholds_outputs());
}

TEST_F(StopControlTest, QuickStopsTheDrivesWhileAnotherNodeIsLost) {
  bus.services.lost_group = true;
  cycle();
  EXPECT_EQ(controlword(0), quick_stop);
  EXPECT_EQ(controlword(1), quick_stop);
  command_all();
  EXPECT_EQ(controlword(0), quick_stop) << "commands are refused";

  bus.services.lost_group = false;
  cycle();
  command_all();
  EXPECT_EQ(controlword(0), enable_operation);
}

TEST_F(StopControlTest, KeepsADriveDisabledThatWasDisabledWhenAnotherNodeWasLost) {
  statusword = 0x40;  // "switch on disabled"
  for (SignalIndex signal = 4; signal < 6; ++signal) {
    bus.pdos.outputs().command(signal, disable_voltage, 1000, {.cycle = beat, .now = now});
  }
  for (int i = 0; i < 10; ++i) cycle();
  bus.services.lost_group = true;
  cycle();
  EXPECT_EQ(controlword(0), disable_voltage);
}

TEST_F(StopControlTest, QuickStopsADisabledDriveThatIsCommandedToEnableWhenAnotherNodeIsLost) {
  statusword = 0x40;
  for (int i = 0; i < 10; ++i) cycle();
  bus.services.lost_group = true;
  cycle();
  EXPECT_EQ(controlword(0), quick_stop);
}

TEST_F(StopControlTest, HaltsTheAxesOfANodeBeforeItsNmtCommandLeaves) {
  bus.services.awaiting = std::uint8_t{2};  // node-ID
  cycle();
  EXPECT_EQ(controlword(0), enable_operation);
  EXPECT_EQ(controlword(1), quick_stop);
  EXPECT_EQ(bus.services.rest, std::nullopt);

  statusword = 0x40;
  for (int i = 0; i < 500 && !bus.services.rest; ++i) cycle();
  EXPECT_EQ(bus.services.rest, AxesAtRest::confirmed);

  bus.services.awaiting.reset();  // the command has left
  cycle();
  command_all();
  EXPECT_EQ(controlword(1), enable_operation);
  EXPECT_TRUE(stop.idle());
}

TEST_F(StopControlTest, StopsInOrderWhenTheFrontThreadAsks) {
  exchange->stop_requested = true;
  cycle();
  EXPECT_EQ(controlword(0), quick_stop);
  EXPECT_FALSE(bus.services.stopping);

  statusword = 0x40;
  for (int i = 0; i < 500 && !stop.done(); ++i) cycle();
  EXPECT_TRUE(bus.services.stopping);
  EXPECT_EQ(bus.services.rest, AxesAtRest::confirmed);
  EXPECT_TRUE(stop.done());
}

TEST_F(StopControlTest, TheMasterIsSilentInNmtStoppedOnlyWhenItsAxesHaveStopped) {
  bus.services.state = NmtState::stopped;
  cycle();
  EXPECT_FALSE(stop.withholds_sync());
  statusword = 0x40;
  for (int i = 0; i < 500 && !stop.withholds_sync(); ++i) cycle();
  EXPECT_TRUE(stop.withholds_sync());
}

struct SyncLossTest : StopControlTest {
  static BusPlan reacting(SyncLoss reaction) {
    BusPlan plan = test::axes();
    plan.cycle.sync_followed = true;
    plan.cycle.on_sync_loss = reaction;
    return plan;
  }
  explicit SyncLossTest(SyncLoss reaction = SyncLoss::hold) : StopControlTest{reacting(reaction)} {}
};

TEST_F(SyncLossTest, HoldsTheOutputsUntilSyncIsBack) {
  stop.follow_sync(true);
  EXPECT_TRUE(stop.withholds_outputs());
  EXPECT_EQ(bus.status.sync_losses, 1U);
  stop.follow_sync(true);
  EXPECT_EQ(bus.status.sync_losses, 1U);
  stop.follow_sync(false);
  EXPECT_FALSE(stop.withholds_outputs());
}

TEST_F(SyncLossTest, IsKnownToAMasterThatContinuesFromACheckpoint) {
  stop.follow_sync(true);
  StateSize size;
  stop.keep(size);
  std::vector<std::uint64_t> words(size.count());
  StateWriter writer{words.data()};
  stop.keep(writer);

  const auto fresh = std::make_unique<BusMachines<FakeNetwork>>(plan, false);
  StopControl<FakeNetwork> other{*fresh};
  EXPECT_FALSE(other.withholds_outputs());
  StateReader reader{words};
  other.keep(reader);
  EXPECT_TRUE(other.withholds_outputs());
}

TEST_F(SyncLossTest, HoldsNoOutputsOfAnOrderedStop) {
  stop.follow_sync(true);
  exchange->stop_requested = true;
  cycle();
  EXPECT_FALSE(stop.withholds_outputs());
}

struct StoppingSyncLoss : SyncLossTest {
  StoppingSyncLoss() : SyncLossTest{SyncLoss::stop} {}
};

TEST_F(StoppingSyncLoss, ReportsTheServicesToStopTheNodesAndToStartThemAgain) {
  stop.follow_sync(true);
  EXPECT_EQ(bus.services.sync_losses, 1);
  stop.follow_sync(false);
  EXPECT_EQ(bus.services.sync_returns, 1);
  EXPECT_FALSE(stop.withholds_outputs());
}

struct FallingSyncLoss : SyncLossTest {
  FallingSyncLoss() : SyncLossTest{SyncLoss::fallback} {}
};

TEST_F(FallingSyncLoss, WritesTheFallbacksOfTheControlwordsAndCallsThemOff) {
  stop.follow_sync(true);
  EXPECT_FALSE(stop.idle());
  cycle();
  ASSERT_EQ(bus.services.submitted.size(), 2U);
  EXPECT_EQ(bus.services.submitted[0].object, (ObjectKey{0x6040, 0}));
  EXPECT_TRUE(stop.idle());

  stop.follow_sync(false);
  EXPECT_EQ(bus.services.withdrawn, std::vector{bus.services.submitted[0].id});
  command_all();
  EXPECT_EQ(controlword(0), enable_operation);
}

}  // namespace
}  // namespace takt
