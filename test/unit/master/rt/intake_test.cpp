#include "master/rt/intake.hpp"

#include <gtest/gtest.h>

#include "test/unit/master/rt/parts_rig.hpp"

namespace takt {
namespace {

const Frame heartbeat = make_frame(CobId::base(0x701), {5});

Frame tpdo(std::uint32_t node) {
  return make_frame(CobId::base(0x180 + node), {0x37, 0x02, 1, 0, 0, 0});
}

/// Both nodes exchange PDOs.
struct IntakeTest : testing::Test {
  explicit IntakeTest(BusPlan plan = test::axes()) : parts{std::move(plan)} {
    parts.bus.takes_pdos = true;
    for (std::size_t node = 0; node < 2; ++node) {
      parts.bus.exchanging[node] = true;
      parts.bus.pdos.inputs().set_reception(node, Reception::full);
    }
  }
  /// One cycle in which the TPDOs come at these times after SYNC. Returns the end of the reception,
  /// as time after SYNC.
  Time cycle(Time first, Time second) {
    parts.await();
    const Time sync = parts.beat.sync_at();
    parts.bus.pdos.inputs().begin(parts.beat.cycle(), sync);
    parts.arrive(sync + first, tpdo(1));
    parts.arrive(sync + second, tpdo(2));
    parts.intake.receive();
    const Time end = parts.port.now() - sync;
    parts.bus.pdos.inputs().close(parts.port.now());
    parts.beat.next();
    return end;
  }
  Parts parts;
};

TEST_F(IntakeTest, GivesTpdosToTheImageAndOtherFramesToTheServices) {
  parts.arrive(10'002'100us, heartbeat);
  cycle(300us, 400us);
  EXPECT_EQ(parts.bus.pdos.image().values[0], 0x237);
  EXPECT_TRUE(parts.bus.pdos.inputs().complete());
  EXPECT_EQ(parts.bus.services.heard, std::vector{heartbeat});
  EXPECT_EQ(parts.bus.status.frames_received, 3U);
}

TEST_F(IntakeTest, WaitsForTheWholeWindowUntilItHasLearnedTheArrival) {
  cycle(300us, 400us);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(cycle(300us, 400us), 1200us);
  EXPECT_EQ(cycle(300us, 400us), 405us);
  EXPECT_EQ(parts.intake.predicted(), 405us);
}

TEST_F(IntakeTest, WaitsOnForALatePdoAndTakesItWhenItComes) {
  for (int i = 0; i < 20; ++i) cycle(300us, 400us);
  EXPECT_EQ(cycle(300us, 700us), 700us);
  EXPECT_EQ(cycle(300us, 5ms), 1200us) << "the end of the receive window";
}

TEST_F(IntakeTest, TakesNothingWhileNobodyExchangesPdos) {
  parts.bus.takes_pdos = false;
  for (std::size_t node = 0; node < 2; ++node) {
    parts.bus.pdos.inputs().set_reception(node, Reception::off);
  }
  EXPECT_EQ(cycle(300us, 400us), 0us) << "the services get the whole slack";
}

struct EventDrivenIntake : IntakeTest {
  EventDrivenIntake() : IntakeTest{test::axes({.tpdo_type = 255})} {}
};

TEST_F(EventDrivenIntake, WaitsForHalfTheWindow) {
  for (int i = 0; i < 20; ++i) EXPECT_EQ(cycle(300us, 400us), 600us);
}

struct FollowingIntake : IntakeTest {
  FollowingIntake() : IntakeTest{followed()} {}
  static BusPlan followed() {
    BusPlan plan = test::axes();
    plan.cycle.sync_followed = true;
    return plan;
  }
};

TEST_F(FollowingIntake, LeavesTheFramesBehindSyncToTheNextCycle) {
  const Frame sync{.id = CobId::base(0x080)};
  parts.arrive(10'002ms, heartbeat);
  parts.arrive(10'002ms, sync);
  parts.arrive(10'002ms, make_frame(CobId::base(0x702), {5}));
  parts.port.sleep_until(10'002ms);
  parts.intake.drain();
  EXPECT_TRUE(parts.beat.next_sync_came());
  EXPECT_EQ(parts.bus.services.heard.size(), 1U);
  EXPECT_FALSE(parts.intake.empty());

  parts.await();
  parts.intake.drain();
  EXPECT_EQ(parts.bus.services.heard.size(), 2U);
  EXPECT_TRUE(parts.intake.empty());
}

}  // namespace
}  // namespace takt
