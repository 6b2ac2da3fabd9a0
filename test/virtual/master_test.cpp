#include <gtest/gtest.h>

#include "master/sim/device/device.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::Rig;

/// A fault that starts now and lasts for `lasts`.
sim::Fault fault_now(Rig& rig, sim::FaultKind kind, std::optional<NodeId> node, Time lasts) {
  sim::Fault fault;
  fault.kind = kind;
  fault.node = node;
  fault.at = rig.world->now();
  fault.until = rig.world->now() + lasts;
  return fault;
}

TEST(Master, BootsTwoAxesAndExchangesTheirPdos) {
  Rig rig{test::axes()};
  ASSERT_TRUE(rig.boot());
  EXPECT_EQ(rig.count(EventKind::boot_done), 2);

  rig.command_all(0x000F, -7, 100);
  rig.run(5);

  EXPECT_EQ(rig.last_image[0], 0x000F);
  EXPECT_EQ(rig.last_image[3], -7);
  EXPECT_EQ(rig.last_stale[0], 0U);
}

TEST(Master, SendsSyncFromBeforeTheFirstStart) {
  Rig rig{test::axes()};
  ASSERT_TRUE(rig.boot());
  const auto syncs = rig.recorder.with(0x080);
  const auto commands = rig.recorder.with(0x000);
  ASSERT_FALSE(syncs.empty());
  ASSERT_FALSE(commands.empty());
  EXPECT_LT(syncs.front().start, commands.front().start);
}

TEST(Master, SyncIsOnTheWireExactlyEachPeriodUnlessADeviceIsSending) {
  Rig rig{test::axes({.nodes = 4})};
  ASSERT_TRUE(rig.boot());
  rig.command_all(0x000F, 1, 1000);
  rig.run(500);
  const auto& frames = rig.recorder.frames;
  Time start{};
  int on_time = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].frame.id != CobId::base(0x080)) continue;
    if (start == Time{}) start = frames[i].start;
    const Time late = (frames[i].start - start) % Time{2ms};
    if (late == 0ns) {
      ++on_time;
      continue;
    }
    // A late SYNC may only come after a frame of another node.
    ASSERT_GT(i, 0U);
    EXPECT_NE(rig.world->node_of(frames[i - 1].sender), 0) << "own frame before SYNC";
    EXPECT_LT(late, 135us);
  }
  EXPECT_GT(on_time, 490);
}

TEST(Master, KeepsTheOrderOfPhasesOnTheWire) {
  Rig rig{test::axes()};
  ASSERT_TRUE(rig.boot());
  rig.command_all(0x000F, 1, 1000);
  rig.run(50);
  rig.recorder.frames.clear();
  rig.run(20);

  Time sync{};
  for (const sim::WireFrame& wire : rig.recorder.frames) {
    const std::uint32_t id = wire.frame.id.id();
    if (id == 0x080) sync = wire.start;
    if (sync == Time{}) continue;
    const Time after = wire.start - sync;
    EXPECT_TRUE((id & 0x7F0) != 0x180 || after < 600us);
    EXPECT_TRUE(id != 0x201 || after == 1600us);  // output_deadline
    EXPECT_TRUE(id != 0x202 || wire.end - sync < 1950us);
  }
  EXPECT_EQ(rig.recorder.with(0x201).size(), 20U);
  EXPECT_EQ(rig.recorder.with(0x202).size(), 20U);
}

TEST(Master, CommandFromImageKActsAtSyncKPlus1) {
  struct Counter final : Controller {
    void update(const ImageView& image, OutputWriter& out) noexcept override {
      for (SignalIndex i = 4; i < 6; ++i) out.set(i, 0x0F);
      for (SignalIndex i = 6; i < 8; ++i) out.set(i, static_cast<std::int64_t>(image.cycle));
    }
  } counter;
  Rig rig{test::axes(), {.master = {.controller = &counter}}};
  ASSERT_TRUE(rig.boot());
  rig.run(20);
  const std::int64_t sent = static_cast<std::int64_t>(rig.last.cycle);
  rig.run(1);
  // The set-point was computed from image k and acts since SYNC k + 1, which sampled the inputs
  // just before.
  EXPECT_EQ(rig.world->device(1_node)->objects().find({0x607A, 0})->value,
            static_cast<std::uint64_t>(sent));
  EXPECT_EQ(rig.last_image[2], sent - 1);
  const auto rpdos = rig.recorder.with(0x201);
  const auto syncs = rig.recorder.with(0x080);
  EXPECT_EQ(rpdos.back().frame.data[2], sent & 0xFF);
  EXPECT_LT(rpdos.back().end, syncs.back().start);
}

TEST(Master, BootsANodeAgainThatWasOffWhileTheOthersKeepCycling) {
  Rig rig{test::axes({.nodes = 3})};
  ASSERT_TRUE(rig.boot());
  rig.command_all(0x000F, 5, 2);
  rig.run(20);
  const auto off = rig.world->now();

  rig.world->power(2_node, false);
  bool others_stale = false;
  rig.on_image = [&](const ImageView& image) {
    others_stale |= (image.stale_bits[0] & 0b101) != 0;
  };
  rig.run(100);
  EXPECT_NE(rig.node(1).boot, BootState::ready);
  EXPECT_TRUE(rig.stale(1));
  rig.world->power(2_node, true);
  rig.events.clear();
  rig.recorder.frames.clear();
  ASSERT_TRUE(rig.boot());
  rig.run(20);

  EXPECT_FALSE(others_stale);
  EXPECT_EQ(rig.count(EventKind::boot_done), 1);
  EXPECT_FALSE(rig.stale(1));
  EXPECT_TRUE(rig.recorder.with(0x202).empty());  // the master has forgotten the old command
  rig.command(1, 0x000F, 6);
  rig.run(3);
  EXPECT_FALSE(rig.recorder.with(0x202).empty());
  EXPECT_EQ(rig.status().cycles_missed, 0U);
  EXPECT_GT(rig.world->now(), off);
}

TEST(Master, AfterAStallOf50MsSendsNoBurstOfSyncs) {
  Rig rig{test::axes()};
  ASSERT_TRUE(rig.boot());
  rig.run(20);
  rig.recorder.frames.clear();
  rig.events.clear();
  rig.world->add(fault_now(rig, sim::FaultKind::stall_master, {}, 50ms));
  rig.run(30);
  const auto syncs = rig.recorder.with(0x080);
  ASSERT_GT(syncs.size(), 20U);
  for (std::size_t i = 1; i < syncs.size(); ++i) {
    EXPECT_GE(syncs[i].start - syncs[i - 1].start, 1ms);
  }
  EXPECT_EQ(rig.count(EventKind::cycles_missed), 1);
  EXPECT_GE(rig.status().cycles_missed, 24U);
}

TEST(Master, ReportsAPdoThatIsMissingAndThatIsBack) {
  Rig rig{test::axes()};
  ASSERT_TRUE(rig.boot());
  rig.run(20);
  rig.events.clear();
  rig.world->add(fault_now(rig, sim::FaultKind::mute_pdo, 2_node, 10ms));
  rig.run(3);
  EXPECT_TRUE(rig.stale(1));
  EXPECT_FALSE(rig.stale(0));
  rig.run(20);
  EXPECT_FALSE(rig.stale(1));
  EXPECT_EQ(rig.count(EventKind::pdo_missing), 1);
  EXPECT_EQ(rig.count(EventKind::pdo_back), 1);
}

TEST(Master, SendsNoCommandThatIsOlderThanItsTimeToLive) {
  Rig rig{test::axes({.fallback_cycles = 5})};
  ASSERT_TRUE(rig.boot());
  rig.recorder.frames.clear();
  rig.command_all(0x000F, 9);
  rig.run(11);
  const auto frames = rig.recorder.with(0x201);
  ASSERT_EQ(frames.size(), 10U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].frame.data[0], i < 5 ? 0x0F : 0x02) << i;
    EXPECT_EQ(frames[i].frame.data[2], 9);
  }
  EXPECT_EQ(rig.count(EventKind::fallback_begun), 2);
}

TEST(Master, NeverSendsAHalfCommandedRpdo) {
  BusPlan plan = test::axes();
  for (Signal& signal : plan.layout.signals) signal.seeded_from.reset();
  Rig rig{plan};
  ASSERT_TRUE(rig.boot());
  rig.master->set(4, 0x000F, 1000);
  rig.master->publish_outputs(rig.world->now());
  rig.run(50);
  EXPECT_TRUE(rig.recorder.with(0x201).empty());
  EXPECT_EQ(rig.count(EventKind::outputs_held), 1);
  rig.master->set(6, 3, 1000);
  rig.master->publish_outputs(rig.world->now());
  rig.run(2);
  EXPECT_EQ(rig.recorder.with(0x201).size(), 1U);
}

TEST(Master, CountsSyncsThatWereSentThroughAnInterfaceThatWasDown) {
  BusPlan plan = test::axes();
  plan.cycle.sync_overflow = 10;
  Rig rig{plan};
  ASSERT_TRUE(rig.boot());
  rig.world->add(fault_now(rig, sim::FaultKind::interface_down, {}, 31ms));
  rig.run(60);
  const auto syncs = rig.recorder.with(0x080);
  for (std::size_t i = 0; i < syncs.size(); ++i) {
    ASSERT_EQ(syncs[i].frame.data[0], i % 10 + 1);
  }
  EXPECT_EQ(rig.count(EventKind::interface_down), 1);
  EXPECT_EQ(rig.count(EventKind::interface_up), 1);
  EXPECT_EQ(rig.status().cycles_missed, 0U);
}

TEST(Master, ExchangesPdosOfEveryRateInBothDirections) {
  for (const std::uint8_t n : std::vector<std::uint8_t>{1, 2, 3, 7, 64, 239, 240}) {
    Rig rig{test::axes({.tpdo_type = n, .rpdo_type = n, .fallback_cycles = 0})};
    ASSERT_TRUE(rig.boot());
    rig.command_all(0x000F, n);
    rig.run(n + 1);  // the master learns the phase
    rig.recorder.frames.clear();
    rig.run(4 * n);
    EXPECT_EQ(rig.recorder.with(0x181).size(), 4U) << int{n};
    EXPECT_EQ(rig.recorder.with(0x201).size(), 4U) << int{n};
    EXPECT_EQ(rig.count(EventKind::pdo_missing), 0) << int{n};
    EXPECT_EQ(rig.last_image[2], n);
  }
}

TEST(Master, WhileObservingPutsNothingOnTheWire) {
  Rig rig{test::axes(), {.master = {.observe = true}}};
  rig.run(200);
  rig.master->request_stop();
  rig.run(20);
  EXPECT_TRUE(rig.master->finished());
  for (const sim::WireFrame& wire : rig.recorder.frames) {
    EXPECT_NE(rig.world->node_of(wire.sender), 0) << to_string(wire.frame.id);
  }
}

TEST(Master, StopsInOrder) {
  Rig rig{test::axes()};
  ASSERT_TRUE(rig.boot());
  rig.command_all(0x000F, 1);
  rig.run(3);
  rig.recorder.frames.clear();
  rig.master->request_stop();
  for (int i = 0; i < 5000 && !rig.master->finished(); ++i) rig.cycle();
  ASSERT_TRUE(rig.master->finished());

  const auto words = rig.recorder.with(0x201);
  const auto commands = rig.recorder.with(0x000);
  const auto syncs = rig.recorder.with(0x080);
  ASSERT_FALSE(words.empty());
  ASSERT_EQ(commands.size(), 2U);
  EXPECT_EQ(commands[0].frame.data[0], 128);  // pre-operational
  EXPECT_LT(words.back().start, commands[0].start);
  EXPECT_GT(syncs.back().start, words.back().start);
  EXPECT_EQ(words.back().frame.data[0] & 0x0F, 0x00);  // a loopback device never shows "disabled"
  EXPECT_EQ(rig.count(EventKind::stopped), 1);
}

TEST(Master, MakesNoSyncInNmtStoppedButOnlyAfterItsAxesStopped) {
  Rig rig{test::axes()};
  ASSERT_TRUE(rig.boot());
  rig.command_all(0x000F, 1);
  rig.run(3);
  rig.recorder.frames.clear();
  ASSERT_TRUE(
      rig.master->submit({.kind = RequestKind::nmt, .node = 127, .command = NmtCommand::stop}));
  rig.run(500);

  const auto words = rig.recorder.with(0x201);
  const auto syncs = rig.recorder.with(0x080);
  ASSERT_FALSE(words.empty());
  ASSERT_FALSE(syncs.empty());
  EXPECT_EQ(words.back().frame.data[0] & 0x0F, 0x00);  // disable voltage
  const auto disable = std::ranges::find_if(
      words, [](const sim::WireFrame& wire) { return (wire.frame.data[0] & 0x0F) == 0; });
  EXPECT_GT(syncs.back().start, disable->start);
  EXPECT_LT(syncs.size(), 250U);

  rig.recorder.frames.clear();
  ASSERT_TRUE(
      rig.master->submit({.kind = RequestKind::nmt, .node = 127, .command = NmtCommand::start}));
  rig.run(20);
  EXPECT_GT(rig.recorder.with(0x080).size(), 15U);
}

}  // namespace
}  // namespace takt
