// Every row of the table of the four manuals against the simulated devices, and the master's own
// part of it against a device in virtual time.
#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <vector>

#include "master/sim/device.hpp"
#include "test/virtual/pdo_matrix_table.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using sim::communicating;
using sim::Device;
using sim::SampleDevice;

constexpr Time started = 200ms;  ///< NMT start of the device

/// The second pair of PDOs: the first of a DRV-28 is its parameter channel.
SampleDevice with_pdos(std::uint8_t type) {
  return communicating(5_node)
      .pdo(0x1401, 0x305, 255, {0x2010'0020})
      .pdo(0x1801, 0x285, type, {0x2011'0020});
}

/// A device that is stepped through the events of a row; the times of the frames of its TPDO2.
class Stepper {
 public:
  explicit Stepper(const SampleDevice& table)
      : table_{table}, device_{table_.build(), sim::Random{1}, {.pdo = 0ns}} {
    device_.power_on(0ns);
    run_to(started - 1ms);
  }

  Device* operator->() { return &device_; }
  void start() {
    run_to(started);
    receive(make_frame(CobId::base(0), {1, 5}));
  }
  void run_to(Time end) {
    while (device_.deadline() <= end) {
      now_ = std::max(now_ + Time{1}, device_.deadline());
      device_.on_time(now_);
      collect();
    }
    now_ = end;
  }
  void receive(const Frame& frame) {
    device_.on_frame(frame, now_);
    collect();
  }
  /// By SDO, so that the device notices at once.
  void change(std::uint8_t value) {
    receive(make_frame(CobId::base(0x605), {0x23, 0x11, 0x20, 0x00, value, 0, 0, 0}));
  }
  std::vector<int> frames;  ///< ms after the start

 private:
  void collect() {
    for (const sim::Transmission& item : device_.out().pending()) {
      if (item.frame.id != CobId::base(0x285)) continue;
      frames.push_back(static_cast<int>((item.ready - started + 500us) / 1ms));
    }
    device_.out().clear();
  }

  SampleDevice table_;
  Device device_;
  Time now_{};
};

/// What happens at one moment, in this order.
struct Moment {
  bool change = false, back = false, sync = false, remote = false, rpdo = false;
};

std::map<int, Moment> moments_of(const test::TpdoRow& row) {
  std::map<int, Moment> moments;
  for (const int ms : row.changes) moments[ms].change = true;
  for (const int ms : row.back) moments[ms].back = true;
  for (const int ms : row.syncs) moments[ms].sync = true;
  for (const int ms : row.remote) moments[ms].remote = true;
  for (const int ms : row.rpdos) moments[ms].rpdo = true;
  return moments;
}

std::vector<int> run(const test::TpdoRow& row) {
  SampleDevice table = with_pdos(row.type);
  table.model(row.model);
  if (*row.quirk != 0) table.quirk(row.quirk);
  Stepper device{table};
  device->objects().find({0x1801, 3})->set(row.inhibit);
  device->objects().find({0x1801, 5})->set(row.timer);
  device.start();
  std::uint8_t value = 0;
  for (const auto& [ms, moment] : moments_of(row)) {
    device.run_to(started + 1ms * ms);
    if (moment.change) device.change(++value);
    if (moment.back) device.change(0);
    if (moment.sync) device.receive({.id = CobId::base(0x080)});
    if (moment.remote) device.receive({.id = CobId::base(0x285), .length = 4, .rtr = true});
    if (moment.rpdo) device.receive(make_frame(CobId::base(0x305), {1, 2, 3, 4}));
  }
  device.run_to(started + 200ms);
  return device.frames;
}

TEST(PdoMatrix, DevicesSendAsTheirManualsSay) {
  for (const test::TpdoRow& row : test::tpdo_rows) EXPECT_EQ(run(row), row.frames) << row.name;
}

TEST(PdoMatrix, EachNthSyncForEveryN) {
  for (int n = 1; n <= 240; ++n) {
    Stepper device{with_pdos(static_cast<std::uint8_t>(n))};
    device.start();
    for (int sync = 1; sync <= 2 * n; ++sync) {
      device.run_to(started + 1ms * sync);
      device.receive({.id = CobId::base(0x080)});
    }
    EXPECT_EQ(device.frames, (std::vector{n, 2 * n}));
  }
}

TEST(PdoMatrix, TheSyncStartValueIsTheFirst) {
  for (const test::StartRow& row : test::start_rows) {
    Stepper device{with_pdos(row.type)};
    device->objects().find({0x1801, 6})->set(row.start);
    device->objects().find({0x1019, 0})->set(row.overflow);
    device.start();
    for (int k = 1; k <= 21; ++k) {
      device.run_to(started + 10ms * k);
      Frame sync{.id = CobId::base(0x080)};
      if (row.overflow != 0) {
        sync =
            make_frame(CobId::base(0x080), {static_cast<std::uint8_t>((k - 1) % row.overflow + 1)});
      }
      device.receive(sync);
    }
    std::vector<int> syncs;
    for (const int ms : device.frames) syncs.push_back(ms / 10);
    EXPECT_EQ(syncs, row.syncs) << row.name;
  }
}

/// The answer of a device to a write of TPDO2's transmission type.
std::uint32_t abort_of_type(const char* model, std::uint8_t type) {
  SampleDevice table = with_pdos(255);
  table.model(model);
  DeviceTable built = table.build();
  Device device{built, sim::Random{1}};
  device.power_on(0ns);
  device.on_time(device.deadline());
  device.out().clear();
  device.on_frame(make_frame(CobId::base(0x605), {0x2F, 0x01, 0x18, 0x02, type, 0, 0, 0}), 300ms);
  device.on_time(400ms);
  for (const sim::Transmission& item : device.out().pending()) {
    if (item.frame.id != CobId::base(0x585)) continue;
    if (item.frame.data[0] == 0x60) return 0;
    return static_cast<std::uint32_t>(item.frame.data[4] | item.frame.data[5] << 8 |
                                      item.frame.data[6] << 16) |
           std::uint32_t{item.frame.data[7]} << 24;
  }
  return 1;
}

TEST(PdoMatrix, ReservedTypesAreRefused) {
  for (const char* model : {"", "plain301", "lenze8400", "beckhoff", "astraada_drv28"}) {
    for (int type = 241; type <= 251; ++type) {
      EXPECT_EQ(abort_of_type(model, static_cast<std::uint8_t>(type)), 0x0609'0030U)
          << model << " " << type;
    }
    EXPECT_EQ(abort_of_type(model, 1), 0U) << model;
    EXPECT_EQ(abort_of_type(model, 240), 0U) << model;
    EXPECT_EQ(abort_of_type(model, 254), 0U) << model;
  }
  for (const std::uint8_t type : std::vector<std::uint8_t>{0, 252, 253}) {
    EXPECT_EQ(abort_of_type("astraada_drv28", type), 0x0609'0030U) << int{type};
    EXPECT_EQ(abort_of_type("lenze8400", type), 0U) << int{type};
  }
}

/// The whole master and one device that gives back what it gets.
class Loop {
 public:
  explicit Loop(const test::LoopRow& row) : rig_{plan_of(row)} {}

  bool boot() { return rig_.boot(); }
  /// One cycle, before whose end the value is commanded.
  void cycle(std::int64_t value) {
    rig_.command(0, 0x000F, value, 1000);
    rig_.recorder.frames.clear();
    rig_.cycle();
  }
  void cycle() {
    rig_.recorder.frames.clear();
    rig_.cycle();
  }
  /// By the outputs of the cycle before: they are on the wire when this one begins.
  bool rpdo_sent() const { return !data_frames(0x201).empty(); }
  bool tpdo_arrived() const { return arrived_; }

 private:
  static BusPlan plan_of(const test::LoopRow& row) {
    BusPlan plan = test::axes({.nodes = 1,
                               .tpdo_type = row.tpdo,
                               .rpdo_type = row.rpdo,
                               .period = 10ms,
                               .fallback_cycles = 0});
    plan.layout.signals[3].seeded_from.reset();
    plan.pdos.rpdos[0].inhibit = 1ms * row.inhibit_ms;
    plan.pdos.rpdos[0].event_timer = 1ms * row.repeat_ms;
    plan.pdos.tpdos[0].poll = 1ms * row.poll_ms;
    return plan;
  }
  std::vector<sim::WireFrame> data_frames(std::uint32_t id) const {
    std::vector<sim::WireFrame> found = rig_.recorder.with(id);
    std::erase_if(found, [](const sim::WireFrame& wire) { return wire.frame.rtr; });
    return found;
  }

  test::Rig rig_;
  bool arrived_ = false;

 public:
  void watch() {
    rig_.on_image = [this](const ImageView& image) {
      arrived_ = image.pdos[0].is(PdoMark::arrived);
    };
  }
};

TEST(PdoMatrix, MasterSendsAndTakesEachType) {
  for (const test::LoopRow& row : test::loop_rows) {
    Loop loop{row};
    ASSERT_TRUE(loop.boot()) << row.name;
    loop.watch();
    for (int i = 0; i < 8; ++i) loop.cycle();  // the frames of the start are over
    std::vector<int> rpdos;
    std::vector<int> arrivals;
    std::int64_t value = 0;
    for (int k = 0; k <= 10; ++k) {
      if (k == 0 || k == 3 || k == 4) ++value;
      k <= 6 ? loop.cycle(value) : loop.cycle();
      if (k >= 1 && loop.rpdo_sent()) rpdos.push_back(k - 1);
      if (k >= 1 && loop.tpdo_arrived()) arrivals.push_back(k);
    }
    EXPECT_EQ(rpdos, row.rpdos) << row.name;
    EXPECT_EQ(arrivals, row.arrivals) << row.name;
  }
}

TEST(PdoMatrix, MasterSendsEachNthCycleForEveryN) {
  for (const std::uint8_t n : std::vector<std::uint8_t>{2, 3, 7, 16, 100, 240}) {
    Loop loop{{"", n, 1, 0, 0, 0, {}, {}}};
    ASSERT_TRUE(loop.boot());
    loop.cycle();  // PDOs are exchanged from here on
    std::vector<int> sent;
    for (int k = 0; k <= 3 * n; ++k) {
      loop.cycle(5);
      if (loop.rpdo_sent()) sent.push_back(k - 1);
    }
    ASSERT_GE(sent.size(), 3U) << int{n};
    // The first at once, then by the raster.
    EXPECT_EQ(sent[0], 0) << int{n};
    for (std::size_t i = 2; i < sent.size(); ++i) EXPECT_EQ(sent[i] - sent[i - 1], n) << int{n};
  }
}

/// Three axes of different types; now and then a stall leaves no room for the frames of all three.
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
    std::vector<Master::Command> commands;
    for (SignalIndex axis = 0; axis < 3; ++axis) {
      commands.push_back({static_cast<SignalIndex>(6 + axis), 0x000F});
      commands.push_back({static_cast<SignalIndex>(9 + axis), round});
    }
    ASSERT_TRUE(rig.master->set_group(commands, rig.world->now(), 10'000));
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

TEST(PdoGroup, WithASignalThatIsNoOutputIsRefusedWhole) {
  test::Rig rig{test::axes()};
  const std::vector<Master::Command> commands{{6, 5}, {0, 5}};
  EXPECT_FALSE(rig.master->set_group(commands, 0ns));
}

}  // namespace
}  // namespace takt
