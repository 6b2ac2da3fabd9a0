// Compares every row of the tables of CiA 301 and of four manuals with the simulated devices.
#include <algorithm>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "master/sim/bus/world.hpp"
#include "test/virtual/pdo_matrix_device.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using sim::communicating;
using sim::Device;
using sim::SampleDevice;
using test::download;
using test::frames_of;
using test::moments_of;
using test::ms_after_start;
using test::started;
using test::Stepper;
using test::with_pdos;

constexpr std::uint32_t refused = 0x0609'0030;

TEST(PdoMatrix, DevicesSendAsTheirManualsSay) {
  for (const test::Reading& reading : test::readings) {
    for (const test::TpdoRow& row : reading.rows) {
      EXPECT_EQ(frames_of(reading, row, 200), row.frames)
          << reading.name << ", type " << int{row.type} << ", " << row.name;
    }
  }
}

TEST(PdoMatrix, EachNthSyncForEveryN) {
  for (const char* model : {"", "plain301", "lenze8400", "beckhoff", "astraada_drv28"}) {
    for (int n = 1; n <= 240; ++n) {
      Stepper device{with_pdos(static_cast<std::uint8_t>(n)).model(model).build()};
      device.start();
      for (int sync = 1; sync <= 2 * n; ++sync) {
        device.run_to(started + 1ms * sync);
        device.receive({.id = CobId::base(0x080)});
      }
      EXPECT_EQ(device.frames(), (std::vector{n, 2 * n})) << model;
    }
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
    test::follow(device, row.course, 100);
    EXPECT_EQ(device.frames(row.transmit_id), row.syncs) << row.name;
    EXPECT_EQ(device.frames(), row.frames) << row.name;
  }
}

/// SYNC and RPDO2 win arbitration against the frame that blocks the bus, TPDO2 does not.
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

struct Acts {
  std::vector<int> when;   ///< times in ms at which the object of RPDO2 changes
  std::uint64_t last = 0;  ///< final value, which is the number of the RPDO2
};

Acts run(const char* model, const test::RpdoRow& row) {
  DeviceTable table = communicating(5_node)
                          .model(model)
                          .pdo(0x1401, 0x305, row.type, {0x2011'0020})
                          .pdo(0x1801, 0x285, 255, {0x2011'0020})
                          .build();
  Stepper device{table};
  device.start();
  Acts acts;
  std::uint8_t sent = 0;
  const auto moments = moments_of({.syncs = row.syncs, .rpdos = row.rpdos});
  for (int ms = 0; ms <= 200; ++ms) {
    device.run_to(started + 1ms * ms);
    const auto moment = moments.find(ms);
    if (moment != moments.end() && moment->second.sync) {
      device.receive({.id = CobId::base(0x080)});
    }
    if (moment != moments.end() && moment->second.rpdo) {
      device.receive(make_frame(CobId::base(0x305), {++sent, 0, 0, 0}));
    }
    const std::uint64_t value = device.value({0x2011, 0});
    if (std::exchange(acts.last, value) != value) acts.when.push_back(ms);
  }
  return acts;
}

TEST(PdoMatrix, RpdosActAtTheNextSyncOrAtOnce) {
  for (const char* model : {"", "plain301", "lenze8400", "beckhoff", "astraada_drv28"}) {
    for (const test::RpdoRow& row : test::rpdo_rows) {
      const Acts acts = run(model, row);
      EXPECT_EQ(acts.when, row.acts) << model << ", type " << int{row.type} << ", " << row.name;
      EXPECT_EQ(acts.last, row.acts.empty() ? 0 : row.rpdos.size())
          << model << ", type " << int{row.type} << ", " << row.name;
    }
  }
}

/// Returns the abort code of a device for a write to this object; 0 means that the device accepts
/// the write, 1 that it does not answer.
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
      // Types 252 and 253 are valid for TPDOs only.
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
