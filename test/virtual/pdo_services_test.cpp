// The complete master with PDOs on request, multiplexed PDOs, 512 PDOs and late frames.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <optional>

#include "master/sim/device/device.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::Rig;

/// Runs until the reply is there. Returns std::nullopt if none comes within 1000 cycles.
std::optional<Reply> ask(Rig& rig, Request request) {
  EXPECT_TRUE(rig.master->submit(request));
  for (int i = 0; i < 1000; ++i) {
    rig.cycle();
    Reply reply;
    if (rig.master->take(reply)) return reply;
  }
  return {};
}

Request pdo_request(RequestKind kind, std::initializer_list<std::uint8_t> bytes = {}) {
  Request request{.id = 5, .kind = kind, .node = 1, .object = {1, 0}};
  for (const std::uint8_t byte : bytes) request.data[request.size++] = std::byte{byte};
  return request;
}

/// RPDO1 is sent on request only; TPDO1 returns its data.
BusPlan pair_plan(std::uint8_t tpdo_type) {
  BusPlan plan = test::axes({.nodes = 1, .tpdo_type = tpdo_type, .rpdo_type = 255});
  plan.pdos.rpdos[0].on_request = true;
  return plan;
}

class RpdoTimes : public testing::TestWithParam<bool> {};

TEST_P(RpdoTimes, AreKeptByAMachineThatWakesUpLate) {
  constexpr Time jitter = 300us;
  BusPlan plan = test::axes({.nodes = 1, .rpdo_type = 255, .period = 10ms, .fallback_cycles = 0});
  (GetParam() ? plan.pdos.rpdos[0].event_timer : plan.pdos.rpdos[0].inhibit) = 20ms;
  Rig rig{plan, {.port = {.wake_jitter = jitter, .spin_jitter = 5us}}};
  ASSERT_TRUE(rig.boot());
  rig.run(5);

  for (int i = 0; i < 200; ++i) {
    if (!GetParam() || i == 0) rig.command(0, 0x0F, i);
    rig.cycle();
  }

  const auto sent = rig.recorder.with(0x201);
  ASSERT_GE(sent.size(), 99U);
  for (std::size_t i = 2; i < sent.size(); ++i) {
    EXPECT_GE(sent[i].start - sent[i - 1].start, 20ms - jitter) << i;
    EXPECT_LE(sent[i].start - sent[i - 1].start, 20ms + jitter) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(EventTimerAndInhibitTime, RpdoTimes, testing::Bool());

TEST(PdoPair, IsAnsweredWithTheBytesOfTheTpdo) {
  Rig rig{pair_plan(255)};
  ASSERT_TRUE(rig.boot());
  rig.run(20);

  const auto reply = ask(rig, pdo_request(RequestKind::pdo_exchange, {0x37, 2, 9, 0, 0, 0}));

  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->fault, SdoFault::none);
  EXPECT_EQ(reply->id, 5U);
  ASSERT_EQ(reply->size, 6);
  EXPECT_EQ(reply->data[0], std::byte{0x37});
  EXPECT_EQ(reply->data[2], std::byte{9});
  EXPECT_EQ(rig.recorder.with(0x201).size(), 1U) << "sent once, and never by itself";
}

TEST(PdoPair, WhoseDeviceStaysMuteTimesOut) {
  Rig rig{pair_plan(255)};
  ASSERT_TRUE(rig.boot());
  rig.run(20);
  rig.world->device(1_node)->faults().mute_pdo = true;

  const auto reply = ask(rig, pdo_request(RequestKind::pdo_exchange, {1, 0, 0, 0, 0, 0}));

  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->fault, SdoFault::timeout);
}

TEST(PdoPair, WithANodeThatIsNotOperationalIsRefused) {
  Rig rig{pair_plan(255)};
  ASSERT_TRUE(rig.boot());
  rig.world->power(1_node, false);
  rig.run(100);

  const auto reply = ask(rig, pdo_request(RequestKind::pdo_exchange, {1, 0, 0, 0, 0, 0}));

  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->fault, SdoFault::not_exchanging);
}

TEST(PdoPoll, OnDemandIsAnsweredByTheDevice) {
  Rig rig{pair_plan(253)};
  ASSERT_TRUE(rig.boot());
  rig.world->device(1_node)->objects().find({0x6040, 0})->set(0x4321);

  const auto reply = ask(rig, pdo_request(RequestKind::pdo_poll));

  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->fault, SdoFault::none);
  ASSERT_EQ(reply->size, 6);
  EXPECT_EQ(reply->data[0], std::byte{0x21});
  EXPECT_EQ(reply->data[1], std::byte{0x43});
  rig.run(1);
  EXPECT_EQ(rig.last_image[0], 0x4321) << "the image has it too";
}

class SyncCounterRestarts : public testing::Test {
 protected:
  SyncCounterRestarts() {
    BusPlan plan = test::axes({.nodes = 1});
    plan.cycle.sync_overflow = 240;
    rig.emplace(plan);
  }
  /// Returns the SYNC counters that follow this command, without those of the cycle in which the
  /// command was sent. Axes may have to stop before the command is sent. A command to the master
  /// alone is never sent.
  std::vector<int> counters_after(NmtCommand command, std::uint8_t node) {
    rig->recorder.frames.clear();
    EXPECT_TRUE(ask(*rig, {.id = 1, .kind = RequestKind::nmt, .node = node, .command = command}));
    const bool alone = node == 127;
    for (int i = 0; i < 20 && !alone && rig->recorder.with(0x000).empty(); ++i) rig->run(1);
    rig->recorder.frames.clear();
    rig->run(3);
    std::vector<int> counters;
    for (const auto& sync : rig->recorder.with(0x080)) counters.push_back(sync.frame.data[0]);
    return counters;
  }

  std::optional<Rig> rig;
};

TEST_F(SyncCounterRestarts, WhenTheMasterLeavesStopped) {
  using testing::ElementsAre;
  ASSERT_TRUE(rig->boot());
  rig->run(10);
  const auto stopped = counters_after(NmtCommand::stop, 0);
  ASSERT_FALSE(stopped.empty()) << "SYNC ends some cycles later";
  EXPECT_GT(stopped[0], 10) << "not yet";
  EXPECT_THAT(counters_after(NmtCommand::start, 0), ElementsAre(1, 2, 3));

  counters_after(NmtCommand::stop, 0);
  EXPECT_THAT(counters_after(NmtCommand::enter_preoperational, 0), ElementsAre(1, 2, 3));
  EXPECT_THAT(counters_after(NmtCommand::start, 0), ElementsAre(5, 6, 7)) << "that goes on";
  rig->run(10);
  EXPECT_GT(counters_after(NmtCommand::stop, 1)[0], 10) << "only the device";

  counters_after(NmtCommand::stop, 127);
  EXPECT_THAT(counters_after(NmtCommand::start, 127), ElementsAre(1, 2, 3)) << "only the master";
}

TEST_F(SyncCounterRestarts, WithEachResetOfTheNetwork) {
  using testing::ElementsAre;
  ASSERT_TRUE(rig->boot());
  rig->run(10);
  EXPECT_THAT(counters_after(NmtCommand::reset_communication, 0), ElementsAre(1, 2, 3));
  rig->run(10);
  EXPECT_THAT(counters_after(NmtCommand::reset_node, 0), ElementsAre(1, 2, 3));
}

/// Node 1: TPDO1 sends 6040 and 607A by source address, RPDO1 takes objects by destination address
/// (0xFF), or objects of its dispatcher list by source address (0xFE), which maps the master's
/// 6040:00 to the device's own 6040:00 and 2100:03 to 607A:00.
test::RigOptions multiplexed_device(std::uint32_t rpdo = 0xFF) {
  using enum DataType;
  sim::SampleDevice device = sim::communicating(1_node);
  device.object(0x6040, 0, unsigned16, Access::rww, 0, true)
      .object(0x607A, 0, integer32, Access::rww, 0, true)
      .object(0x1FA0, 0, unsigned8, Access::constant, 2)
      .object(0x1FA0, 1, unsigned32, Access::rw, 0x0160'4000)
      .object(0x1FA0, 2, unsigned32, Access::rw, 0x0160'7A00)
      .object(0x1FD0, 0, unsigned8, Access::constant, 2)
      .object(0x1FD0, 1, unsigned64, Access::rw, 0x0160'4000'6040'007F)
      .object(0x1FD0, 2, unsigned64, Access::rw, 0x0160'7A00'2100'037F)
      .pdo(0x1400, 0x201, 255, {})
      .pdo(0x1800, 0x181, 255, {});
  DeviceTable table = device.build();
  for (DeviceObject& object : table.objects) {
    if (object.key == ObjectKey{0x1600, 0}) object.value = sim::little_endian(rpdo, 1);
    if (object.key == ObjectKey{0x1A00, 0}) object.value = sim::little_endian(0xFE, 1);
  }
  return {.devices = {table}};
}

/// Makes a separate row for each object in `headers`, with fields as in the plan.
void multiplex(std::vector<PdoRow>& rows, BusPlan& plan, std::array<std::uint32_t, 2> headers) {
  PdoRow row = rows[0];
  row.length = 8;
  rows.clear();
  for (std::uint16_t i = 0; i < 2; ++i) {
    row.header = headers[i];
    row.siblings = i == 0 ? 2 : 0;
    row.field_count = 1;
    plan.pdos.fields[row.first_field].bit_offset = 32;
    rows.push_back(row);
    ++row.first_field;
  }
}

TEST(Mpdo, GoesBothWaysByObject) {
  BusPlan plan = test::axes({.nodes = 1, .tpdo_type = 255, .rpdo_type = 255, .fallback_cycles = 0});
  plan.layout.signals[3].seeded_from.reset();
  multiplex(plan.pdos.tpdos, plan, {0x0060'4001, 0x0060'7A01});
  multiplex(plan.pdos.rpdos, plan, {0x0060'4081, 0x0060'7A81});
  Rig rig{plan, multiplexed_device()};
  ASSERT_TRUE(rig.boot());
  rig.run(10);

  rig.command(0, 0x000F, -5, 100);
  rig.run(5);

  const auto sent = rig.recorder.with(0x201);
  ASSERT_EQ(sent.size(), 2U);
  EXPECT_EQ(sent[1].frame,
            make_frame(CobId::base(0x201), {0x81, 0x7A, 0x60, 0x00, 0xFB, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(rig.world->device(1_node)->objects().number({0x607A, 0}), -5);
  EXPECT_EQ(rig.recorder.with(0x181).back().frame,
            make_frame(CobId::base(0x181), {0x01, 0x7A, 0x60, 0x00, 0xFB, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(rig.last_image[0], 0x000F);
  EXPECT_EQ(rig.last_image[1], -5);
}

TEST(Mpdo, GoesBySourceFromTheMasterToTheDispatchingListOfTheDevice) {
  BusPlan plan = test::axes({.nodes = 1, .tpdo_type = 255, .rpdo_type = 255, .fallback_cycles = 0});
  plan.layout.signals[3].seeded_from.reset();
  multiplex(plan.pdos.tpdos, plan, {0x0060'4001, 0x0060'7A01});
  multiplex(plan.pdos.rpdos, plan, {0x0060'407F, 0x0321'007F});
  Rig rig{plan, multiplexed_device(0xFE)};
  ASSERT_TRUE(rig.boot());
  rig.run(10);

  rig.command(0, 0x000F, -5, 100);
  rig.run(5);
  rig.command(0, 0x000F, 7, 100);
  rig.run(5);

  const auto sent = rig.recorder.with(0x201);
  ASSERT_EQ(sent.size(), 3U) << "only what has changed";
  EXPECT_EQ(sent[0].frame, make_frame(CobId::base(0x201), {0x7F, 0x40, 0x60, 0x00, 0x0F, 0, 0, 0}));
  EXPECT_EQ(sent[1].frame,
            make_frame(CobId::base(0x201), {0x7F, 0x00, 0x21, 0x03, 0xFB, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(sent[2].frame, make_frame(CobId::base(0x201), {0x7F, 0x00, 0x21, 0x03, 7, 0, 0, 0}));
  EXPECT_EQ(rig.world->device(1_node)->objects().number({0x6040, 0}), 0x000F);
  EXPECT_EQ(rig.world->device(1_node)->objects().number({0x607A, 0}), 7);
  EXPECT_EQ(rig.last_image[1], 7);
}

TEST(ManyPdos, All512WithOneSyncAreInOneImage) {
  BusPlan plan = test::axes({.nodes = 1, .period = 200ms});
  using enum DataType;
  sim::SampleDevice device = sim::communicating(1_node);
  device.object(0x6040, 0, unsigned16, Access::rww, 0x1234, true);
  PdoRow row = plan.pdos.tpdos[0];
  plan.pdos.tpdos.clear();
  plan.pdos.route[0x181] = PdoTable::no_row;
  row.field_count = 1;
  row.length = 2;
  for (std::uint16_t i = 0; i < 512; ++i) {
    row.number = static_cast<std::uint16_t>(i + 1);
    row.cob_id = CobId::extended(0x10000u + i);
    plan.pdos.tpdos.push_back(row);
    const auto communication = static_cast<std::uint16_t>(0x1800 + i);
    const auto mapping = static_cast<std::uint16_t>(communication + 0x200);
    device.object(communication, 0, unsigned8, Access::constant, 2)
        .object(communication, 1, unsigned32, Access::rw, 0x2001'0000u + i)
        .object(communication, 2, unsigned8, Access::rw, 1)
        .object(mapping, 0, unsigned8, Access::rw, 1)
        .object(mapping, 1, unsigned32, Access::rw, 0x6040'0010);
  }
  plan.pdos.rpdos.clear();
  Rig rig{plan, {.devices = {device.build()}, .heartbeat_timeout = 1s}};
  ASSERT_TRUE(rig.boot());
  rig.run(3);
  std::size_t arrived = 0;
  rig.on_image = [&](const ImageView& image) {
    arrived = 0;
    for (const PdoMark& mark : image.pdos) arrived += mark.is(PdoMark::arrived);
    EXPECT_EQ(image.missing, 0U);
  };
  rig.run(1);
  EXPECT_EQ(arrived, 512U);
  EXPECT_EQ(rig.last_image[0], 0x1234);
}

TEST(ManyPdos, All512OfOneSetOfCommandsActWithOneSync) {
  BusPlan plan = test::axes({.nodes = 1, .period = 400ms});
  plan.nodes[0].cia402 = false;
  plan.pdos.tpdos.clear();
  plan.pdos.route[0x181] = PdoTable::no_row;
  plan.pdos.fields.clear();
  plan.layout = {};
  PdoRow row = plan.pdos.rpdos[0];
  plan.pdos.rpdos.clear();
  row.field_count = 1;
  row.length = 2;
  sim::SampleDevice device = sim::communicating(1_node);
  for (std::uint16_t i = 0; i < 512; ++i) {
    const auto object = static_cast<std::uint16_t>(0x2100 + i);
    plan.layout.signals.push_back(test::make_signal(1_node, 0, {object, 0}));
    plan.layout.signals.back().output = true;
    plan.pdos.fields.push_back({.signal = i, .bit_offset = 0, .bits = 16});
    row.number = static_cast<std::uint16_t>(i + 1);
    row.first_field = i;
    row.cob_id = CobId::extended(0x10000u + i);
    plan.pdos.rpdos.push_back(row);
    const auto communication = static_cast<std::uint16_t>(0x1400 + i);
    const auto mapping = static_cast<std::uint16_t>(communication + 0x200);
    using enum DataType;
    device.object(object, 0, unsigned16, Access::rww, 0, true)
        .object(communication, 0, unsigned8, Access::constant, 2)
        .object(communication, 1, unsigned32, Access::rw, 0x2001'0000u + i)
        .object(communication, 2, unsigned8, Access::rw, 1)
        .object(mapping, 0, unsigned8, Access::rw, 1)
        .object(mapping, 1, unsigned32, Access::rw, std::uint32_t{object} << 16U | 0x10U);
  }
  Rig rig{plan, {.devices = {device.build()}, .heartbeat_timeout = 2s, .port = {.tx_queue = 600}}};
  ASSERT_TRUE(rig.boot());
  rig.run(2);
  const auto acted = [&] {
    int count = 0;
    for (std::uint16_t i = 0; i < 512; ++i) {
      const ObjectKey object{static_cast<std::uint16_t>(0x2100 + i), 0};
      count += rig.world->device(1_node)->objects().number(object) == i + 1;
    }
    return count;
  };

  for (SignalIndex i = 0; i < 512; ++i) rig.master->set(i, i + 1, 0);
  rig.master->publish_outputs(rig.world->now());
  std::vector<int> after_each_sync;
  for (int i = 0; i < 4; ++i) {
    rig.cycle();
    after_each_sync.push_back(acted());
  }

  EXPECT_EQ(std::ranges::count(after_each_sync, 0) + std::ranges::count(after_each_sync, 512), 4)
      << "all or none";
  EXPECT_EQ(after_each_sync.back(), 512);
}

TEST(SynchronousWindow, FramesOfASlowDeviceAreReportedAndUsedOrDropped) {
  for (const bool drop : {false, true}) {
    BusPlan plan = test::axes({.nodes = 1, .period = 4ms});
    plan.cycle.sync_window = 500us;
    plan.pdos.tpdos[0].drop_late = drop;
    Rig rig{plan};
    ASSERT_TRUE(rig.boot());
    rig.run(20);
    sim::Fault slow;
    slow.kind = sim::FaultKind::delay;
    slow.node = 1_node;
    slow.at = rig.world->now();
    slow.until = slow.at + 10s;
    slow.time = 2ms;  // random delay, at most this
    rig.world->add(slow);
    rig.run(3);
    int late = 0;
    int arrived = 0;
    rig.on_image = [&](const ImageView& image) {
      late += image.pdos[0].is(PdoMark::late);
      arrived += image.pdos[0].is(PdoMark::arrived);
    };
    rig.run(50);
    EXPECT_GT(late, 20) << drop;
    if (drop) {
      EXPECT_LT(arrived, 30);
    } else {
      EXPECT_EQ(arrived, 50);
    }
    EXPECT_GE(rig.count(EventKind::pdo_late), 1);
  }
}

}  // namespace
}  // namespace takt
