// Every row of the tables of CiA 301 and of four manuals against the simulated devices.
#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <utility>
#include <vector>

#include "master/sim/device.hpp"
#include "master/sim/world.hpp"
#include "test/virtual/pdo_matrix_preset.hpp"
#include "test/virtual/pdo_matrix_table.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using sim::communicating;
using sim::Device;
using sim::SampleDevice;

constexpr Time started = 200ms;  ///< NMT start of the device
constexpr std::uint32_t refused = 0x0609'0030;

/// The second pair of PDOs: the first of a DRV-28 is its parameter channel.
SampleDevice with_pdos(std::uint8_t type, std::uint32_t cob = 0x285) {
  return communicating(5_node)
      .pdo(0x1401, 0x305, 255, {0x2010'0020})
      .pdo(0x1801, cob, type, {0x2011'0020});
}

/// Expedited download to node 5.
Frame download(ObjectKey key, std::uint32_t value, unsigned bytes) {
  const auto byte = [](std::uint32_t bits) { return static_cast<std::uint8_t>(bits & 0xFF); };
  return make_frame(CobId::base(0x605), {byte(0x23u | (4 - bytes) << 2), byte(key.index),
                                         byte(std::uint32_t{key.index} >> 8), key.sub, byte(value),
                                         byte(value >> 8), byte(value >> 16), byte(value >> 24)});
}

int ms_after_start(Time when) { return static_cast<int>((when - started + 500us) / 1ms); }

/// A device that is stepped through the events of a row, and when it has sent what.
class Stepper {
 public:
  explicit Stepper(DeviceTable table)
      : table_{std::move(table)}, device_{table_, sim::Random{1}, {.pdo = 0ns}} {
    device_.power_on(0ns);
    run_to(started - 1ms);
  }

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
  void change(std::uint8_t value) { receive(download({0x2011, 0}, value, 4)); }
  /// In ms after the start.
  std::vector<int> frames(std::uint32_t id = 0x285) const {
    std::vector<int> times;
    for (const sim::Transmission& item : sent_) {
      if (item.frame.id == CobId::base(id)) times.push_back(ms_after_start(item.ready));
    }
    return times;
  }

 private:
  void collect() {
    const auto pending = device_.out().pending();
    sent_.insert(sent_.end(), pending.begin(), pending.end());
    device_.out().clear();
  }

  DeviceTable table_;
  Device device_;
  std::vector<sim::Transmission> sent_;
  Time now_{};
};

/// What happens at one moment, in this order.
struct Moment {
  bool change = false, back = false, sync = false, remote = false, rpdo = false;
};

std::map<int, Moment> moments_of(const test::Course& course) {
  std::map<int, Moment> moments;
  for (const int ms : course.changes) moments[ms].change = true;
  for (const int ms : course.back) moments[ms].back = true;
  for (const int ms : course.syncs) moments[ms].sync = true;
  for (const int ms : course.remote) moments[ms].remote = true;
  for (const int ms : course.rpdos) moments[ms].rpdo = true;
  return moments;
}

DeviceTable device_of(const test::Reading& reading, const test::TpdoRow& row) {
  SampleDevice sample = with_pdos(row.type, row.course.no_rtr ? 0x4000'0285 : 0x285);
  sample.model(reading.model);
  if (*reading.quirk != 0) sample.quirk(reading.quirk);
  DeviceTable table = sample.build();
  test::preset(table, {0x1801, 3}, row.course.inhibit);
  test::preset(table, {0x1801, 5}, row.course.timer);
  return table;
}

std::vector<int> run(const test::Reading& reading, const test::TpdoRow& row) {
  Stepper device{device_of(reading, row)};
  device.start();
  std::uint8_t value = 0;
  for (const auto& [ms, moment] : moments_of(row.course)) {
    device.run_to(started + 1ms * ms);
    if (moment.change) device.change(++value);
    if (moment.back) device.change(0);
    if (moment.sync) device.receive({.id = CobId::base(0x080)});
    if (moment.remote) device.receive({.id = CobId::base(0x285), .length = 4, .rtr = true});
    if (moment.rpdo) device.receive(make_frame(CobId::base(0x305), {1, 2, 3, 4}));
  }
  device.run_to(started + 200ms);
  return device.frames();
}

TEST(PdoMatrix, DevicesSendAsTheirManualsSay) {
  for (const test::Reading& reading : test::readings) {
    for (const test::TpdoRow& row : reading.rows) {
      EXPECT_EQ(run(reading, row), row.frames)
          << reading.name << ", type " << int{row.type} << ", " << row.name;
    }
  }
}

TEST(PdoMatrix, EachNthSyncForEveryN) {
  for (int n = 1; n <= 240; ++n) {
    Stepper device{with_pdos(static_cast<std::uint8_t>(n)).build()};
    device.start();
    for (int sync = 1; sync <= 2 * n; ++sync) {
      device.run_to(started + 1ms * sync);
      device.receive({.id = CobId::base(0x080)});
    }
    EXPECT_EQ(device.frames(), (std::vector{n, 2 * n}));
  }
}

TEST(PdoMatrix, TheSyncStartValueIsTheFirst) {
  for (const test::StartRow& row : test::start_rows) {
    DeviceTable table = with_pdos(row.type).build();
    test::preset(table, {0x1801, 6}, row.start);
    test::preset(table, {0x1019, 0}, row.overflow);
    Stepper device{table};
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
    for (const int ms : device.frames()) syncs.push_back(ms / 10);
    EXPECT_EQ(syncs, row.syncs) << row.name;
  }
}

TEST(PdoMatrix, TheirOwnSyncTriggersThemWhereTheManualSaysSo) {
  for (const test::OwnSyncRow& row : test::own_sync_rows) {
    SampleDevice sample = with_pdos(row.type);
    sample.model(row.model)
        .object(0x5E8F, 0, DataType::unsigned16, Access::rw, 0x080)   // C00368, Tx identifier
        .object(0x5E90, 0, DataType::unsigned16, Access::rw, 0x080);  // C00367, Rx identifier
    DeviceTable table = sample.build();
    table.firmware = row.firmware;
    Stepper device{table};
    device.run_to(started);
    device.receive(download({0x1006, 0}, 20'000, 4));
    device.receive(download({0x1005, 0}, 0x4000'0080, 4));
    device.receive(download({0x5E8F, 0}, row.transmit_id, 2));
    device.start();
    device.run_to(started + 100ms);
    EXPECT_EQ(device.frames(row.transmit_id), row.syncs) << row.name;
    EXPECT_EQ(device.frames(), row.frames) << row.name;
  }
}

/// SYNC and RPDO2 win against the frame that blocks the bus, TPDO2 does not.
std::vector<int> run(const test::BlockedRow& row) {
  DeviceTable table = communicating(5_node)
                          .model("plain301")
                          .quirk("event_timer_raster")
                          .pdo(0x1401, 0x181, 255, {0x2011'0020})
                          .pdo(0x1801, 0x285, row.type, {0x2011'0020})
                          .build();
  test::preset(table, {0x1801, 3}, row.course.inhibit);
  test::preset(table, {0x1801, 5}, row.course.timer);
  test::preset(table, {0x1007, 0}, static_cast<std::uint64_t>(row.window) * 1000);
  sim::World world{std::span{&table, 1}, {}};
  test::Recorder recorder;
  world.observe(&recorder);
  sim::RemotePort& port = world.attach();
  if (row.until != 0) {
    world.add({.kind = sim::FaultKind::babble,
               .at = started + 1ms * row.from,
               .until = started + 1ms * row.until,
               .cob_id = CobId::base(0x182),
               .value = std::vector<std::byte>(8)});
  }
  const auto send_at = [&](int ms, const Frame& frame) {
    world.advance_to(started + 1ms * ms);
    port.send(std::span{&frame, 1}, world.now());
  };
  send_at(0, make_frame(CobId::base(0), {1, 5}));
  std::uint8_t value = 0;
  for (const auto& [ms, moment] : moments_of(row.course)) {
    if (moment.change) send_at(ms, make_frame(CobId::base(0x181), {++value, 0, 0, 0}));
    if (moment.sync) send_at(ms, {.id = CobId::base(0x080)});
  }
  world.advance_to(started + 201ms);
  std::vector<int> frames;
  for (const sim::WireFrame& wire : recorder.with(0x285)) {
    frames.push_back(ms_after_start(wire.start));
  }
  return frames;
}

TEST(PdoMatrix, OnABlockedBusTheFirstAttemptCounts) {
  for (const test::BlockedRow& row : test::blocked_rows) {
    EXPECT_EQ(run(row), row.frames) << "type " << int{row.type} << ", " << row.name;
  }
}

/// What RPDO2 brings goes out by TPDO2, by event.
std::vector<int> run(const char* model, const test::RpdoRow& row) {
  Stepper device{communicating(5_node)
                     .model(model)
                     .pdo(0x1401, 0x305, row.type, {0x2011'0020})
                     .pdo(0x1801, 0x285, 255, {0x2011'0020})
                     .build()};
  device.start();
  std::uint8_t value = 0;
  for (const auto& [ms, moment] : moments_of({.syncs = row.syncs, .rpdos = row.rpdos})) {
    device.run_to(started + 1ms * ms);
    if (moment.sync) device.receive({.id = CobId::base(0x080)});
    if (moment.rpdo) device.receive(make_frame(CobId::base(0x305), {++value, 0, 0, 0}));
  }
  device.run_to(started + 200ms);
  std::vector<int> acts = device.frames();
  std::erase(acts, 0);  // the state at the start
  return acts;
}

TEST(PdoMatrix, RpdosActAtTheNextSyncOrAtOnce) {
  for (const char* model : {"", "plain301", "lenze8400", "beckhoff"}) {
    for (const test::RpdoRow& row : test::rpdo_rows) {
      EXPECT_EQ(run(model, row), row.acts)
          << model << ", type " << int{row.type} << ", " << row.name;
    }
  }
}

/// The answer of a device to a write to this object, 0: it is taken.
std::uint32_t abort_of(const DeviceTable& table, ObjectKey key, std::uint32_t value) {
  Device device{table, sim::Random{1}};
  device.power_on(0ns);
  device.on_time(device.deadline());
  device.out().clear();
  device.on_frame(download(key, value, key.sub == 1 ? 4 : 1), 300ms);
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

TEST(PdoMatrix, TypesThatAManualLacksAreRefused) {
  for (const test::TypesRow& row : test::types_rows) {
    const DeviceTable table = with_pdos(255).model(row.model).build();
    for (int type = 0; type <= 255; ++type) {
      const bool reserved = type >= 241 && type <= 251;
      const bool lacking = reserved || std::ranges::count(row.refused, type) != 0;
      const auto value = static_cast<std::uint32_t>(type);
      EXPECT_EQ(abort_of(table, {0x1801, 2}, value), lacking ? refused : 0U)
          << row.name << ", type " << type;
      // 252 and 253 are of TPDOs.
      EXPECT_EQ(abort_of(table, {0x1401, 2}, value), type >= 241 && type <= 253 ? refused : 0U)
          << row.name << ", RPDO, type " << type;
    }
  }
}

TEST(PdoMatrix, TypesOfRemoteRequestsOnlyAreRefusedWithoutThem) {
  for (const test::Bit30Row& row : test::bit30_rows) {
    const DeviceTable table = with_pdos(row.type, 0x8000'0285).build();
    EXPECT_EQ(abort_of(table, {0x1801, 1}, 0x4000'0285), row.refused ? refused : 0U) << row.name;
    EXPECT_EQ(abort_of(table, {0x1801, 1}, 0x0000'0285), 0U) << row.name;
  }
}

}  // namespace
}  // namespace takt
