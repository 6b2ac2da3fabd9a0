// The master's part of the PDO matrix: a complete master and a device in virtual time.
#include "test/virtual/pdo_matrix_master.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

#include "master/sim/device/device.hpp"
#include "test/virtual/pdo_matrix_preset.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// A complete master and one device that returns the data that it receives.
class Loop {
 public:
  explicit Loop(const test::LoopRow& row) : Loop{row, plan_of(row)} {}

  bool boot() { return rig_.boot(); }
  /// Runs one cycle and commands the value before its end.
  void cycle(std::int64_t value) {
    rig_.command(0, 0x000F, value, 1000);
    rig_.recorder.frames.clear();
    rig_.cycle();
  }
  void cycle() {
    rig_.recorder.frames.clear();
    rig_.cycle();
  }
  /// True if the cycle before has sent RPDO1: those outputs are on the wire when this cycle begins.
  bool rpdo_sent() const { return !data_frames(0x201).empty(); }
  bool tpdo_arrived() const { return arrived_; }
  bool tpdo_missing() const { return missing_; }

 private:
  Loop(const test::LoopRow& row, const BusPlan& plan)
      : rig_{plan, {.devices = {device_of(row.pair, plan.pdos)}}} {}

  static BusPlan plan_of(const test::LoopRow& row) {
    BusPlan plan = test::axes({.nodes = 1,
                               .tpdo_type = row.tpdo,
                               .rpdo_type = row.rpdo,
                               .period = 10ms,
                               .fallback_cycles = 0});
    plan.layout.signals[3].seeded_from.reset();
    plan.pdos.rpdos[0].inhibit = 1ms * row.pair.inhibit;
    plan.pdos.rpdos[0].event_timer = 1ms * row.pair.repeat;
    plan.pdos.tpdos[0].poll = 1ms * row.pair.poll;
    plan.pdos.tpdos[0].poll_syncs = static_cast<std::uint16_t>(row.pair.poll_syncs);
    plan.pdos.tpdos[0].deadline = 1ms * row.pair.deadline;
    return plan;
  }
  static DeviceTable device_of(const test::Pair& pair, const PdoTable& pdos) {
    DeviceTable table = test::loopback_device(1_node, pdos.tpdos[0], pdos.rpdos[0]);
    table.model = pair.model;
    if (*pair.quirk != 0) table.quirks.emplace_back(pair.quirk);
    test::preset(table, {0x1800, 3}, static_cast<std::uint64_t>(pair.silence) * 10);
    test::preset(table, {0x1800, 5}, static_cast<std::uint64_t>(pair.timer));
    return table;
  }
  std::vector<sim::WireFrame> data_frames(std::uint32_t id) const {
    std::vector<sim::WireFrame> found = rig_.recorder.with(id);
    std::erase_if(found, [](const sim::WireFrame& wire) { return wire.frame.rtr; });
    return found;
  }

  test::Rig rig_;
  bool arrived_ = false;
  bool missing_ = false;

 public:
  void watch() {
    rig_.on_image = [this](const ImageView& image) {
      arrived_ = image.pdos[0].is(PdoMark::arrived);
      missing_ = image.pdos[0].is(PdoMark::missing);
    };
  }
};

TEST(PdoMatrix, MasterSendsAndTakesEachType) {
  for (const test::LoopRow& row : test::loop_rows) {
    const testing::Message name = testing::Message()
                                  << int{row.rpdo} << " and " << int{row.tpdo} << ": " << row.name;
    Loop loop{row};
    ASSERT_TRUE(loop.boot()) << name;
    loop.watch();
    for (int i = 0; i < 8; ++i) loop.cycle();  // the frames of the start have passed
    for (int i = 0; i < 8 && row.pair.after_arrival && !loop.tpdo_arrived(); ++i) loop.cycle();
    std::vector<int> rpdos;
    std::vector<int> arrivals;
    std::vector<int> missing;
    std::int64_t value = 0;
    for (int k = 0; k <= 10; ++k) {
      if (k == 0 || k == 3 || k == 4) ++value;
      k <= 6 ? loop.cycle(value) : loop.cycle();
      if (k >= 1 && loop.rpdo_sent()) rpdos.push_back(k - 1);
      if (k >= 1 && loop.tpdo_arrived()) arrivals.push_back(k);
      if (k >= 1 && loop.tpdo_missing()) missing.push_back(k);
    }
    EXPECT_EQ(rpdos, row.rpdos) << name;
    EXPECT_EQ(arrivals, row.arrivals) << name;
    EXPECT_EQ(missing, row.missing) << name;
  }
}

std::vector<int> sent_by_master(std::uint8_t type, bool event, bool timer, bool inhibit) {
  Loop loop{{"", type, 255, {.inhibit = inhibit ? 30 : 0, .repeat = timer ? 20 : 0}, {}, {}}};
  EXPECT_TRUE(loop.boot());
  for (int i = 0; i < 8; ++i) loop.cycle();  // the frames of the start have passed
  std::vector<int> sent;
  std::int64_t value = 0;
  for (int k = 0; k <= 10; ++k) {
    if (k == 0 || (event && (k == 3 || k == 4))) ++value;
    k <= 6 ? loop.cycle(value) : loop.cycle();
    if (k >= 1 && loop.rpdo_sent()) sent.push_back(k - 1);
  }
  return sent;
}

TEST(PdoMatrix, MasterSendsAsEachCellSays) {
  int cells = 0;
  for (const std::uint8_t type : std::vector<std::uint8_t>{0, 1, 254, 255}) {
    for (unsigned combination = 0; combination < 8; ++combination) {
      const bool has[] = {(combination & 1) != 0, (combination & 2) != 0, (combination & 4) != 0};
      for (const test::RpdoCell& cell : test::rpdo_cells) {
        if (std::ranges::count(cell.types, type) == 0) continue;
        bool matches = true;
        for (std::size_t i = 0; i < 3; ++i) {
          matches = matches && (cell.pattern[i] == '.' || (cell.pattern[i] != '-') == has[i]);
        }
        if (!matches) continue;
        ++cells;
        EXPECT_EQ(sent_by_master(type, has[0], has[1], has[2]), cell.rpdos)
            << "type " << int{type} << ", " << cell.pattern;
      }
    }
  }
  EXPECT_EQ(cells, 4 * 8) << "each combination once";
}

TEST(PdoMatrix, MasterAndDeviceKeepTheirRasters) {
  for (const test::RasterRow& row : test::raster_rows) {
    Loop loop{{"", row.rpdo, row.tpdo, {.model = row.model}, {}, {}}};
    ASSERT_TRUE(loop.boot()) << row.name;
    loop.watch();
    loop.cycle();
    std::vector<int> sent;
    std::vector<int> arrivals;
    for (int k = 0; k < 5 * std::max(row.rpdo, row.tpdo); ++k) {
      loop.cycle(k);
      if (loop.rpdo_sent()) sent.push_back(k - 1);
      if (loop.tpdo_arrived()) arrivals.push_back(k);
      EXPECT_FALSE(loop.tpdo_missing()) << row.name << " " << k;
    }
    ASSERT_GE(sent.size(), 4U) << row.name;
    ASSERT_GE(arrivals.size(), 4U) << row.name;
    // The first frame comes at once, the others in the raster.
    for (std::size_t i = 2; i < sent.size(); ++i) {
      EXPECT_EQ(sent[i] - sent[i - 1], row.rpdo) << row.name;
    }
    for (std::size_t i = 1; i < arrivals.size(); ++i) {
      EXPECT_EQ(arrivals[i] - arrivals[i - 1], row.tpdo) << row.name;
    }
  }
}

/// Returns the counters of the SYNCs that a TPDO1 followed.
std::vector<int> counters_before(const std::vector<sim::WireFrame>& frames) {
  std::vector<int> counters;
  int counter = 0;
  for (const sim::WireFrame& wire : frames) {
    if (wire.frame.id == CobId::base(0x080)) counter = wire.frame.data[0];
    if (wire.frame.id == CobId::base(0x181)) counters.push_back(counter);
  }
  return counters;
}

TEST(PdoMatrix, TheSyncStartValueCountsInTheSyncOfTheMaster) {
  for (const test::MasterStartRow& row : test::master_start_rows) {
    BusPlan plan = test::axes({.nodes = 1, .tpdo_type = row.type, .period = 10ms});
    plan.cycle.sync_overflow = row.overflow;
    plan.pdos.tpdos[0].sync_start = row.start;
    DeviceTable table = test::loopback_device(1_node, plan.pdos.tpdos[0], plan.pdos.rpdos[0]);
    test::preset(table, {0x1800, 6}, row.start);
    test::preset(table, {0x1019, 0}, row.overflow);
    test::Rig rig{plan, {.devices = {table}}};
    ASSERT_TRUE(rig.boot()) << row.name;
    rig.run(50);
    std::vector<int> counters = counters_before(rig.recorder.frames);
    ASSERT_GE(counters.size(), row.counters.size()) << row.name;
    counters.resize(row.counters.size());
    EXPECT_EQ(counters, row.counters) << row.name;
  }
}

TEST(PdoMatrix, MasterSendsEachNthCycleForEveryN) {
  for (int every = 1; every <= 240; ++every) {
    const auto n = static_cast<std::uint8_t>(every);
    // Type n uses neither the inhibit time nor the event timer.
    Loop loop{{"", n, 1, {.inhibit = n % 2 * 30, .repeat = n % 2 * 20}, {}, {}}};
    ASSERT_TRUE(loop.boot());
    loop.cycle();  // PDOs are exchanged from here on
    std::vector<int> sent;
    for (int k = 0; k <= 3 * n; ++k) {
      loop.cycle(5);
      if (loop.rpdo_sent()) sent.push_back(k - 1);
    }
    ASSERT_GE(sent.size(), 3U) << int{n};
    // The first frame comes at once, the others in the raster.
    EXPECT_EQ(sent[0], 0) << int{n};
    for (std::size_t i = 2; i < sent.size(); ++i) EXPECT_EQ(sent[i] - sent[i - 1], n) << int{n};
  }
}

/// Three axes have different types. From time to time a stall leaves no room for the frames of all
/// three.
TEST(PdoGroup, OneCommandBecomesValidWithOneSyncForAllAxes) {
  BusPlan plan = test::axes({.nodes = 3, .rpdo_type = 0, .period = 4ms});
  plan.pdos.rpdos[1].transmission = 5;
  plan.pdos.rpdos[2].transmission = 1;
  test::Rig rig{plan};
  ASSERT_TRUE(rig.boot());
  rig.command_all(0x000F, 1, 10'000);
  rig.run(10);
  const auto target = [&](NodeId node) {
    return rig.world->device(node)->objects().find({0x607A, 0})->value;
  };
  for (int round = 2; round < 60; ++round) {
    if (round % 3 == 0) {  // the bus thread sleeps almost to the next SYNC
      sim::Fault stall;
      stall.kind = sim::FaultKind::stall_master;
      stall.at = rig.world->now() + 900us;
      stall.until = rig.world->now() + 4700us;
      rig.world->add(stall);
    }
    for (unsigned axis = 0; axis < 3; ++axis) {
      ASSERT_TRUE(rig.master->set(static_cast<SignalIndex>(6 + axis), 0x000F, 10'000));
      ASSERT_TRUE(rig.master->set(static_cast<SignalIndex>(9 + axis), round, 10'000));
    }
    rig.master->publish_outputs(rig.world->now());
    for (int cycle = 0; cycle < 6; ++cycle) {
      rig.cycle();
      const auto first = target(1_node);
      EXPECT_EQ(target(2_node), first) << "round " << round << " cycle " << cycle;
      EXPECT_EQ(target(3_node), first) << "round " << round << " cycle " << cycle;
    }
    EXPECT_EQ(target(1_node), static_cast<std::uint64_t>(round));
  }
  EXPECT_GT(rig.status().outputs_skipped, 0U) << "no slack was too short";
}

}  // namespace
}  // namespace takt
