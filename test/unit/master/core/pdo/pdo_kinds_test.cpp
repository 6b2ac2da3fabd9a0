// The mark that PdoInputs gives each PDO, the synchronous window, the deadline, and multiplexed
// PDOs.
#include <gtest/gtest.h>
#include <memory>
#include <utility>
#include <vector>

#include "master/core/pdo/pdo_exchange.hpp"
#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// The inputs of a plan and a bus with a SYNC every 2 ms. The tests take images as the bus loop
/// does.
class Bus {
 public:
  explicit Bus(BusPlan plan)
      : plan_{std::move(plan)}, image{plan_.layout.signals.size()}, pdos{plan_, image, *events} {
    for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
      pdos.set_reception(i, Reception::full);
    }
  }
  void beat() {
    now_ = ++cycle * Time{2ms};
    pdos.begin(static_cast<std::uint64_t>(cycle), now_);
  }
  void frame(CobId id, std::initializer_list<std::uint8_t> bytes, Time after = 300us) {
    pdos.receive({.frame = make_frame(id, bytes), .when = now_ + after});
  }
  void frame(Time after = 300us) { frame(CobId::base(0x181), {0x37, 2, 1, 0, 0, 0}, after); }
  /// Closes the cycle and returns the mark of the first TPDO in its image.
  PdoMark close() {
    pdos.close(now_ + Time{1200us});
    const PdoMark mark = pdos.marks()[0];
    pdos.forget_marks();
    return mark;
  }
  std::vector<EventKind> reported() {
    std::vector<EventKind> all;
    for (Event event; events->pop(event);) all.push_back(event.kind);
    return all;
  }

 private:
  BusPlan plan_;
  Time now_{};
  std::unique_ptr<EventQueue> events = std::make_unique<EventQueue>();

 public:
  WorkingImage image;
  PdoInputs pdos;
  std::int64_t cycle = 0;
};

BusPlan one_axis(std::uint8_t type = 1) { return test::axes({.nodes = 1, .tpdo_type = type}); }

TEST(PdoMarks, ReportWhatArrivedAndTheAgeOfWhatDidNot) {
  Bus bus{one_axis()};
  bus.beat();
  bus.frame();
  const PdoMark first = bus.close();
  EXPECT_TRUE(first.is(PdoMark::arrived));
  EXPECT_EQ(first.received, 1U);
  EXPECT_TRUE(first.toggle());
  EXPECT_EQ(first.cycle, 1U);

  bus.beat();
  const PdoMark second = bus.close();
  EXPECT_EQ(second.flags, PdoMark::missing);
  EXPECT_EQ(second.received, 1U);
  EXPECT_EQ(second.cycle, 1U) << "one cycle old";

  bus.beat();
  bus.frame();
  const PdoMark third = bus.close();
  EXPECT_EQ(third.flags, PdoMark::arrived);
  EXPECT_FALSE(third.toggle());
}

TEST(PdoMarks, ReportShortAndLongFramesApart) {
  Bus bus{one_axis()};
  bus.beat();
  bus.frame(CobId::base(0x181), {1, 2, 3});
  EXPECT_EQ(bus.close().flags, PdoMark::too_short);

  bus.beat();
  bus.frame(CobId::base(0x181), {0x40, 2, 3, 0, 0, 0, 9, 9});
  EXPECT_EQ(bus.close().flags, PdoMark::too_long | PdoMark::arrived);
  EXPECT_EQ(bus.image.values[0], 0x0240);
  EXPECT_EQ(bus.pdos.status(0).length_errors, 2U);
  EXPECT_EQ(bus.pdos.status(0).too_long, 1U);
}

TEST(PdoMarks, OfAFrameBetweenTwoImagesAreInTheSecond) {
  Bus bus{one_axis(255)};
  bus.beat();
  bus.close();
  bus.frame(1500us);  // in the slack of cycle 1
  bus.beat();
  const PdoMark mark = bus.close();
  EXPECT_TRUE(mark.is(PdoMark::arrived));
  EXPECT_EQ(mark.cycle, 1U);
}

TEST(SynchronousWindow, CountsAndReportsLateFramesOnceAndUsesThem) {
  BusPlan plan = one_axis();
  plan.cycle.sync_window = 500us;
  Bus bus{plan};
  bus.beat();
  bus.frame(500us);
  EXPECT_EQ(bus.close().flags, PdoMark::arrived);
  for (int i = 0; i < 3; ++i) {
    bus.beat();
    bus.frame(501us);
    EXPECT_EQ(bus.close().flags, PdoMark::arrived | PdoMark::late);
  }
  EXPECT_EQ(bus.pdos.status(0).late, 3U);
  EXPECT_EQ(bus.pdos.status(0).missing, 0U);
  EXPECT_EQ(bus.reported(), std::vector{EventKind::pdo_late});

  bus.beat();
  bus.frame(400us);
  bus.close();
  bus.beat();
  bus.frame(600us);
  EXPECT_EQ(bus.reported(), std::vector{EventKind::pdo_late}) << "it began anew";
}

TEST(SynchronousWindow, DropsLateFramesWhereThatIsChosen) {
  BusPlan plan = one_axis();
  plan.cycle.sync_window = 500us;
  plan.pdos.tpdos[0].drop_late = true;
  Bus bus{plan};
  bus.beat();
  bus.frame();
  bus.close();
  bus.beat();
  bus.frame(CobId::base(0x181), {0x99, 0, 0, 0, 0, 0}, 600us);
  EXPECT_EQ(bus.close().flags, PdoMark::late | PdoMark::missing);
  EXPECT_EQ(bus.image.values[0], 0x0237);
  EXPECT_TRUE(bus.image.is_stale(0));
  EXPECT_EQ(bus.pdos.status(0).received, 1U);
}

TEST(SynchronousWindow, IsTheReceiveWindowWhereNoneIsGiven) {
  Bus bus{one_axis()};
  bus.beat();
  bus.frame();
  bus.close();
  bus.beat();
  bus.close();  // the window of 1200 us is over: missing
  bus.frame(1250us);
  bus.beat();
  bus.frame();
  const PdoMark mark = bus.close();
  EXPECT_EQ(mark.flags, PdoMark::arrived | PdoMark::late);
  EXPECT_EQ(bus.reported(), (std::vector{EventKind::pdo_missing, EventKind::pdo_back}))
      << "what is missing is not told to be late as well";
}

TEST(SynchronousWindow, DoesNotConcernEventDrivenPdos) {
  for (const std::uint8_t type : std::vector<std::uint8_t>{252, 253, 254, 255}) {
    BusPlan plan = one_axis(type);
    plan.cycle.sync_window = 500us;
    Bus bus{plan};
    bus.beat();
    bus.frame(1100us);
    EXPECT_EQ(bus.close().flags, PdoMark::arrived) << int{type};
  }
}

TEST(Deadline, IsArmedByTheFirstFrame) {
  BusPlan plan = one_axis(255);
  plan.pdos.tpdos[0].deadline = 9ms;
  Bus bus{plan};
  for (int i = 0; i < 50; ++i) {
    bus.beat();
    EXPECT_EQ(bus.close().flags, 0);
  }
  EXPECT_TRUE(bus.reported().empty());

  bus.beat();
  bus.frame();
  bus.close();
  int missing = 0;
  for (int i = 0; i < 50; ++i) {
    bus.beat();
    missing += bus.close().is(PdoMark::missing);
  }
  EXPECT_EQ(missing, 1);
  EXPECT_EQ(bus.reported(), std::vector{EventKind::pdo_missing});
}

/// Node 1 sends 6041 and 6064 by source address on 0x281.
BusPlan sam_plan(CobId id) {
  BusPlan plan = one_axis();
  PdoRow row = plan.pdos.tpdos[0];
  row.cob_id = id;
  row.number = 2;
  row.transmission = 255;
  row.length = 8;
  row.field_count = 1;
  plan.pdos.route[0x181] = PdoTable::no_row;
  plan.pdos.tpdos.clear();
  if (!id.is_extended()) plan.pdos.route[id.id()] = 0;
  for (unsigned i = 0; i < 2; ++i) {
    row.header = i == 0 ? 0x0060'4101u : 0x0060'6401u;
    row.siblings = i == 0 ? 2 : 0;
    row.first_field = static_cast<std::uint16_t>(i);
    plan.pdos.fields[i].bit_offset = 32;
    plan.pdos.tpdos.push_back(row);
  }
  return plan;
}

TEST(MultiplexedTpdo, PutsEachObjectIntoItsSignal) {
  for (const CobId id : {CobId::base(0x281), CobId::extended(0x1ABCDE)}) {
    Bus bus{sam_plan(id)};
    bus.beat();
    bus.frame(id, {0x01, 0x64, 0x60, 0x00, 0xFE, 0xFF, 0xFF, 0xFF});
    EXPECT_EQ(bus.image.values[1], -2);
    EXPECT_TRUE(bus.image.is_stale(0)) << "the other object has not come";
    EXPECT_FALSE(bus.image.is_stale(1));

    bus.frame(id, {0x01, 0x41, 0x60, 0x00, 0x37, 0x02, 0, 0});
    EXPECT_EQ(bus.image.values[0], 0x0237);
    bus.frame(id, {0x02, 0x41, 0x60, 0x00, 0x99, 0x02, 0, 0});
    bus.frame(id, {0x01, 0x42, 0x60, 0x00, 0x99, 0x02, 0, 0});
    bus.frame(id, {0x01});
    EXPECT_EQ(bus.image.values[0], 0x0237) << "another node, another object, no object";
    EXPECT_EQ(bus.pdos.status(0).received, 1U);
    EXPECT_EQ(bus.pdos.status(1).received, 1U);
  }
}

TEST(MultiplexedTpdo, ByDestinationIsTakenForTheMasterAndForAll) {
  BusPlan plan = sam_plan(CobId::base(0x281));
  plan.pdos.tpdos[0].header = 0x0060'41FF;  // node 127
  plan.pdos.tpdos[1].header = 0x0060'64FF;
  Bus bus{plan};
  bus.beat();
  bus.frame(CobId::base(0x281), {0xFF, 0x41, 0x60, 0x00, 0x37, 0x02, 0, 0});
  EXPECT_EQ(bus.image.values[0], 0x0237);
  bus.frame(CobId::base(0x281), {0x80, 0x41, 0x60, 0x00, 0x38, 0x02, 0, 0});
  EXPECT_EQ(bus.image.values[0], 0x0238);
  bus.frame(CobId::base(0x281), {0x85, 0x41, 0x60, 0x00, 0x39, 0x02, 0, 0});
  EXPECT_EQ(bus.image.values[0], 0x0238) << "for node 5";
}

}  // namespace
}  // namespace takt
