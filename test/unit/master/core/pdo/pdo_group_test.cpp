// The times at which RPDOs are sent: type 0, type n, events inside the inhibit time, several with
// one SYNC, MPDO.
#include <gtest/gtest.h>
#include <memory>
#include <utility>
#include <vector>

#include "master/core/pdo/pdo_exchange.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// Axes with one RPDO each and a cycle of 2 ms. The tests command the targets by hand.
class Axes {
 public:
  explicit Axes(BusPlan plan) : plan_{std::move(plan)}, nodes_{plan_.nodes.size()} {
    points_.resize(plan_.layout.outputs());
    for (std::size_t i = 0; i < nodes_; ++i) pdos_.outputs().open(i, points_);
    for (std::size_t i = 0; i < nodes_; ++i) set(i, 0);
  }
  /// Adds the controlword 0x0F and this target to the present set of commands.
  void set(std::size_t axis, std::int64_t target) {
    points_[axis] = {0x0F, points_[axis].generation + 1, 0, {}};
    points_[nodes_ + axis] = {target, points_[nodes_ + axis].generation + 1, 0, {}};
  }
  /// Runs the next cycle and returns the COB-IDs of its frames.
  std::vector<std::uint32_t> cycle(std::size_t accepted = 100) {
    ++cycle_;
    const Time now = static_cast<Time::rep>(cycle_) * Time{2ms};
    frames.clear();
    std::vector<std::uint32_t> ids;
    const OutputMoment moment{.cycle = cycle_, .now = now};
    for (const Frame& frame : pdos_.outputs().pack(points_, moment)) {
      frames.push_back(frame);
      ids.push_back(frame.id.id());
    }
    pdos_.outputs().sent(accepted, moment);
    return ids;
  }
  std::vector<Frame> frames;

 private:
  BusPlan plan_;
  std::size_t nodes_;
  std::unique_ptr<EventQueue> events_ = std::make_unique<EventQueue>();
  PdoExchange pdos_{plan_, *events_};
  std::vector<SetPoint> points_;
  std::uint64_t cycle_ = 0;
};

using Ids = std::vector<std::uint32_t>;

BusPlan axes(unsigned nodes, std::uint8_t type) {
  BusPlan plan = test::axes({.nodes = nodes, .rpdo_type = type, .fallback_cycles = 0});
  for (Signal& signal : plan.layout.signals) signal.seeded_from.reset();
  return plan;
}

TEST(RpdoType0, GoesOutOnlyWhenAValueHasChanged) {
  BusPlan plan = axes(1, 0);
  plan.pdos.rpdos[0].inhibit = 100ms;  // means nothing for synchronous PDOs
  Axes bus{plan};
  EXPECT_EQ(bus.cycle(), (Ids{0x201}));
  for (int i = 0; i < 5; ++i) {
    bus.set(0, 0);
    EXPECT_TRUE(bus.cycle().empty()) << "commanded again, not changed";
  }
  bus.set(0, 5);
  EXPECT_EQ(bus.cycle(), (Ids{0x201}));
  EXPECT_TRUE(bus.cycle().empty());
  bus.set(0, 6);
  EXPECT_EQ(bus.cycle(), (Ids{0x201}));
}

TEST(RpdoType0, OfSeveralAxesGoOutInOneCycle) {
  Axes bus{axes(3, 0)};
  bus.cycle();
  bus.set(0, 1);
  bus.set(2, 3);
  EXPECT_EQ(bus.cycle(), (Ids{0x201, 0x203}));
}

TEST(RpdoGroup, ThatFindsNoRoomWaitsAsAWhole) {
  Axes bus{axes(3, 0)};
  bus.cycle();
  for (std::size_t i = 0; i < 3; ++i) bus.set(i, 7);
  EXPECT_EQ(bus.cycle(0), (Ids{0x201, 0x202, 0x203})) << "offered, but the slack was too short";
  EXPECT_EQ(bus.cycle(), (Ids{0x201, 0x202, 0x203}));
  EXPECT_TRUE(bus.cycle().empty());
}

TEST(RpdoTypeN, GoesOutEachNthCycleInOneRasterForAll) {
  Axes bus{axes(2, 3)};
  std::vector<int> sent;
  for (int i = 0; i < 12; ++i) {
    if (!bus.cycle().empty()) sent.push_back(i);
  }
  EXPECT_EQ(sent, (std::vector{0, 3, 6, 9}));
}

TEST(RpdoTypeN, CommandedAloneWaitsForItsTurn) {
  BusPlan plan = axes(2, 4);
  Axes bus{plan};
  bus.cycle();
  bus.set(0, 1);
  EXPECT_TRUE(bus.cycle().empty());
  EXPECT_TRUE(bus.cycle().empty());
  EXPECT_TRUE(bus.cycle().empty());
  EXPECT_EQ(bus.cycle(), (Ids{0x201, 0x202}));
}

TEST(RpdoGroup, OfDifferentRatesActsAtOneSync) {
  BusPlan plan = axes(3, 1);
  plan.pdos.rpdos[1].transmission = 10;
  plan.pdos.rpdos[2].transmission = 0;
  Axes bus{plan};
  bus.cycle();
  EXPECT_EQ(bus.cycle(), (Ids{0x201}));
  for (std::size_t i = 0; i < 3; ++i) bus.set(i, 9);
  EXPECT_EQ(bus.cycle(), (Ids{0x201, 0x202, 0x203}));
  EXPECT_EQ(bus.cycle(), (Ids{0x201}));
}

TEST(RpdoGroup, OfWhichTheInterfaceTookAPartSendsTheRestNext) {
  Axes bus{axes(3, 0)};
  bus.cycle();
  for (std::size_t i = 0; i < 3; ++i) bus.set(i, 7);
  bus.cycle(1);
  EXPECT_EQ(bus.cycle(), (Ids{0x202, 0x203}));
}

TEST(RpdoType255, KeepsAnEventInsideTheInhibitTime) {
  BusPlan plan = axes(1, 255);
  plan.pdos.rpdos[0].inhibit = 10ms;  // five cycles
  Axes bus{plan};
  EXPECT_EQ(bus.cycle(), (Ids{0x201}));
  bus.set(0, 1);
  EXPECT_TRUE(bus.cycle().empty());
  bus.set(0, 0);  // the value returns to the sent one, but the event remains
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(bus.cycle().empty());
  EXPECT_EQ(bus.cycle(), (Ids{0x201}));
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(bus.cycle().empty());
}

TEST(RpdoType255, IsRepeatedByItsTimer) {
  BusPlan plan = axes(1, 255);
  plan.pdos.rpdos[0].event_timer = 6ms;
  Axes bus{plan};
  std::vector<int> sent;
  for (int i = 0; i < 10; ++i) {
    if (i == 4) bus.set(0, 1);
    if (!bus.cycle().empty()) sent.push_back(i);
  }
  EXPECT_EQ(sent, (std::vector{0, 3, 4, 7})) << "the timer begins anew with each frame";
}

TEST(MultiplexedRpdo, SendsEachObjectByDestination) {
  BusPlan plan = axes(1, 255);
  PdoRow row = plan.pdos.rpdos[0];
  plan.pdos.rpdos.clear();
  row.length = 8;
  row.field_count = 1;
  for (unsigned i = 0; i < 2; ++i) {  // 6040 and 607A of node 1
    row.header = i == 0 ? 0x0060'4081u : 0x0060'7A81u;
    row.first_field = static_cast<std::uint16_t>(2 + i);
    plan.pdos.fields[2 + i].bit_offset = 32;
    plan.pdos.rpdos.push_back(row);
  }
  Axes bus{plan};
  bus.set(0, -2);
  bus.cycle();
  ASSERT_EQ(bus.frames.size(), 2U);
  EXPECT_EQ(bus.frames[0],
            make_frame(CobId::base(0x201), {0x81, 0x40, 0x60, 0x00, 0x0F, 0x00, 0x00, 0x00}));
  EXPECT_EQ(bus.frames[1],
            make_frame(CobId::base(0x201), {0x81, 0x7A, 0x60, 0x00, 0xFE, 0xFF, 0xFF, 0xFF}));

  bus.set(0, 3);
  bus.cycle();
  ASSERT_EQ(bus.frames.size(), 1U) << "only what changed";
}

}  // namespace
}  // namespace takt
