#include <algorithm>
#include <cstdio>
#include <gtest/gtest.h>
#include <numeric>

#include "master/explain/boot_report.hpp"
#include "master/sim/device/device.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::Rig;

constexpr ObjectKey domain{0x2020, 0};

std::vector<std::byte> some_bytes(std::size_t size) {
  std::vector<std::byte> bytes(size);
  unsigned value = 1;
  for (std::byte& byte : bytes) {
    value = value * 1664525 + 1013904223;
    byte = static_cast<std::byte>(value >> 24);
  }
  return bytes;
}

/// A plan with one axis, a large budget, and no SYNC, so that the bus is quiet.
BusPlan quiet_plan() {
  BusPlan plan = test::axes({.nodes = 1, .period = 20ms});
  plan.cycle.sync = false;
  plan.cycle.receive_window = 1ms;
  plan.cycle.output_deadline = 19500us;
  plan.cycle.service_frames = 250;
  return plan;
}

class SdoTransfers : public testing::Test {
 protected:
  void start(BusPlan plan = quiet_plan()) {
    rig.emplace(std::move(plan));
    ASSERT_TRUE(rig->boot());
    rig->recorder.frames.clear();
  }
  sim::SdoFaults& faults() { return rig->world->device(1_node)->faults().sdo; }
  std::vector<std::byte>& stored() {
    return rig->world->device(1_node)->objects().find(domain)->bytes;
  }
  SdoTransfer& buffer() { return rig->master->transfers()[0]; }

  Reply transfer(RequestKind kind) {
    buffer().cancel = false;
    Request request{.id = 7, .kind = kind, .node = 1, .object = domain, .timeout = timeout};
    request.transfer = &buffer();
    EXPECT_TRUE(rig->master->submit(request));
    cycles = 0;
    for (Reply reply; cycles < 5000; ++cycles) {
      rig->cycle();
      if (rig->master->take(reply)) return reply;
      if (buffer().done >= call_off_at) buffer().cancel = true;
    }
    ADD_FAILURE() << "no reply";
    return {};
  }
  Reply download(std::size_t size) {
    buffer().data = some_bytes(size);
    return transfer(RequestKind::sdo_download);
  }
  Reply upload(std::size_t size) {
    stored() = some_bytes(size);
    buffer().data.assign(size + 100, std::byte{});
    return transfer(RequestKind::sdo_upload);
  }
  void expect_downloaded(std::size_t size) {
    EXPECT_EQ(download(size).fault, SdoFault::none);
    EXPECT_EQ(buffer().done, size);
    EXPECT_EQ(stored(), some_bytes(size));
  }
  void expect_uploaded(std::size_t size) {
    EXPECT_EQ(upload(size).fault, SdoFault::none);
    ASSERT_EQ(buffer().done, size);
    buffer().data.resize(size);
    EXPECT_EQ(buffer().data, some_bytes(size));
  }
  /// Returns the share of the time from the first to the last SDO frame in which SDO frames occupy
  /// the wire.
  double wire_share() const {
    Time first = never;
    Time last{};
    Time busy{};
    for (const sim::WireFrame& wire : rig->recorder.frames) {
      const std::uint32_t id = wire.frame.id.id();
      if (id != 0x601 && id != 0x581) continue;
      first = std::min(first, wire.start);
      last = std::max(last, wire.end + 3us);
      busy += wire.end + 3us - wire.start;
    }
    return std::chrono::duration<double>(busy) / std::chrono::duration<double>(last - first);
  }

  std::optional<Rig> rig;
  int cycles = 0;
  Time timeout = 100ms;
  std::uint32_t call_off_at = 0xFFFF'FFFF;
};

TEST_F(SdoTransfers, ABlockDownloadFillsTheWireOfAQuietBus) {
  start();
  expect_downloaded(65536);
  EXPECT_GE(wire_share(), 0.95);
  std::printf("block download: %.2f %% of the wire\n", 100 * wire_share());
}

TEST_F(SdoTransfers, ABlockUploadFillsTheWireOfAQuietBus) {
  start();
  expect_uploaded(65536);
  EXPECT_EQ(buffer().announced, 65536U);
  EXPECT_GE(wire_share(), 0.90);
  std::printf("block upload: %.2f %% of the wire\n", 100 * wire_share());
}

TEST_F(SdoTransfers, ABlockDownloadUsesTheWholeBudgetBesidePdos) {
  BusPlan plan = test::axes();
  plan.cycle.service_frames = 4;
  start(std::move(plan));
  expect_downloaded(14000);  // 2000 segments, 16 sub-blocks, begin and end
  EXPECT_LE(cycles, static_cast<int>(2018 / 4 / 0.95));
  EXPECT_EQ(rig->status().images_incomplete, 0U);
  EXPECT_EQ(rig->status().outputs_skipped, 0U);
  EXPECT_EQ(rig->status().send_failures, 0U);
  std::printf("block download beside PDOs: %.2f %% of the budget\n", 100 * 2018 / 4.0 / cycles);
}

TEST_F(SdoTransfers, SyncStaysOnTheBeatBesideABlockDownload) {
  BusPlan plan = test::axes();
  plan.cycle.service_frames = 16;
  start(std::move(plan));
  expect_downloaded(14000);
  const auto syncs = rig->recorder.with(0x080);
  for (std::size_t i = 1; i < syncs.size(); ++i) {
    const Time late = syncs[i].start - syncs[i - 1].start;
    EXPECT_GT(late, 2ms - 135us);
    EXPECT_LT(late, 2ms + 135us);
  }
}

constexpr CobId sync_id = CobId::base(0x080);
constexpr CobId heartbeat_id = CobId::base(0x77F);

/// The segments of the device have priority over the heartbeat of the master, which waits before
/// SYNC in the queue of the master's controller.
class SlowBus : public SdoTransfers {
 protected:
  SlowBus() {
    BusPlan plan = test::axes({.nodes = 2, .period = 10ms});
    plan.bitrate = 125'000;
    plan.master_heartbeat = 50ms;
    plan.cycle.service_frames = 4;
    test::RigOptions options;
    options.world.bitrate = plan.bitrate;
    rig.emplace(std::move(plan), options);
    EXPECT_TRUE(rig->boot());
    rig->recorder.frames.clear();
  }
  void expect_beat(CobId id, Time period, Time late) const {
    const auto frames = rig->recorder.with(id.id());
    ASSERT_GT(frames.size(), 10U);
    for (std::size_t i = 1; i < frames.size(); ++i) {
      EXPECT_LE(frames[i].start - frames[i - 1].start, period + late);
    }
  }
  static constexpr Time longest_frame = 135 * 8us;
};

TEST_F(SlowBus, SyncAndHeartbeatStayOnTheBeatBesideABlockUpload) {
  expect_uploaded(20000);

  expect_beat(sync_id, 10ms, longest_frame);
  expect_beat(heartbeat_id, 50ms, 40ms);
}

TEST_F(SlowBus, SyncStaysOnTheBeatWhereABlockUploadIsCalledOff) {
  for (call_off_at = 500; call_off_at < 1500; call_off_at += 35) {
    EXPECT_EQ(upload(3000).fault, SdoFault::cancelled);
    rig->run(10);
  }

  expect_beat(sync_id, 10ms, longest_frame);
}

TEST_F(SdoTransfers, AServerThatFallsSilentHoldsTheHeartbeatUpForAMoment) {
  BusPlan plan = quiet_plan();
  plan.master_heartbeat = 20ms;
  start(std::move(plan));
  timeout = 1s;
  faults().silent_after = 20;
  EXPECT_EQ(upload(1000).fault, SdoFault::timeout);
  const auto frames = rig->recorder.with(heartbeat_id.id());
  ASSERT_GT(frames.size(), 20U);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_LE(frames[i].start - frames[i - 1].start, 80ms);
  }
}

TEST_F(SdoTransfers, FillsATransmitQueueOfTenWithoutOverrunningIt) {
  test::RigOptions options;
  options.port.tx_queue = 10;
  rig.emplace(quiet_plan(), options);
  ASSERT_TRUE(rig->boot());
  expect_downloaded(20000);
  EXPECT_EQ(rig->status().send_failures, 0U);
}

TEST_F(SdoTransfers, GoWithEveryBlockSize) {
  start();
  for (const std::uint8_t segments : {std::uint8_t{1}, std::uint8_t{3}, std::uint8_t{127}}) {
    faults().block_size = segments;
    expect_downloaded(1000);
    expect_downloaded(7 * 127);
    expect_downloaded(7 * 127 + 1);
  }
}

TEST_F(SdoTransfers, RepeatALostSegmentWhereverItIs) {
  start();
  timeout = 1s;  // the device confirms after 0.7 s if the last segment of a block is missing
  for (const unsigned lost : {1U, 2U, 126U, 127U, 128U, 142U, 143U}) {
    SCOPED_TRACE(lost);
    faults() = {.lose_segment = lost};
    expect_downloaded(1000);  // 143 segments
    expect_uploaded(1000);
    faults().early_confirm = true;
    expect_downloaded(1000);
  }
}

TEST_F(SdoTransfers, FallBackToSegments) {
  start();
  faults().refuse_block = true;
  expect_downloaded(300);
  expect_uploaded(300);
}

TEST_F(SdoTransfers, GoBySegmentsWhereTheDeviceIsMuteForBlocks) {
  start();
  faults().mute_block = true;
  expect_downloaded(300);
  EXPECT_GE(cycles, 5) << "it has waited for an answer";
  expect_downloaded(300);
  expect_uploaded(300);
  ASSERT_EQ(rig->count(EventKind::no_sdo_block), 1);
  const auto reported = std::ranges::find(rig->events, EventKind::no_sdo_block, &Event::kind);
  EXPECT_NE(
      describe(quiet_plan(), *reported).find("gives no answer to SDO block transfer (2020:00)"),
      std::string::npos)
      << describe(quiet_plan(), *reported);

  start();
  faults().mute_block = true;
  expect_uploaded(300);
  EXPECT_EQ(rig->count(EventKind::no_sdo_block), 1);
}

TEST_F(SdoTransfers, WorkWithoutCrc) {
  start();
  faults().no_crc = true;
  expect_downloaded(1000);
  expect_uploaded(1000);
}

TEST_F(SdoTransfers, WorkWithoutAnAnnouncedSizeOrWithOneTooLarge) {
  start();
  faults().no_size = true;
  expect_uploaded(1000);
  faults() = {.announce_more = 5};
  expect_uploaded(1000);
  faults().refuse_block = true;
  expect_uploaded(1000);
}

TEST_F(SdoTransfers, EndWithTheCodeOfWhatWentWrong) {
  start();
  struct Case {
    const char* what;
    sim::SdoFaults faults;
    SdoFault fault;
    std::uint32_t code;
  };
  const Case downloads[] = {
      {"wrong CRC", {.wrong_crc = true}, SdoFault::aborted_by_device, 0x0504'0004},
      {"wrong ackseq", {.wrong_ackseq = true}, SdoFault::aborted_by_master, 0x0504'0003},
      {"silent", {.silent_after = 20}, SdoFault::timeout, 0x0504'0000},
      {"aborts", {.abort_after = 20}, SdoFault::aborted_by_device, 0x0800'0000},
      {"block size 0", {.wrong_block_size = true}, SdoFault::aborted_by_master, 0x0504'0002},
  };
  for (const Case& item : downloads) {
    SCOPED_TRACE(item.what);
    faults() = item.faults;
    const Reply reply = download(1000);
    EXPECT_EQ(reply.fault, item.fault);
    EXPECT_EQ(reply.abort_code, item.code);
    faults() = {};
    expect_downloaded(200);  // the channel is free again
  }
  const Case uploads[] = {
      {"wrong CRC", {.wrong_crc = true}, SdoFault::aborted_by_master, 0x0504'0004},
      {"silent", {.silent_after = 20}, SdoFault::timeout, 0x0504'0000},
      {"one byte more", {.announce_more = -7}, SdoFault::aborted_by_master, 0x0607'0012},
  };
  for (const Case& item : uploads) {
    SCOPED_TRACE(item.what);
    faults() = item.faults;
    const Reply reply = upload(1000);
    EXPECT_EQ(reply.fault, item.fault);
    EXPECT_EQ(reply.abort_code, item.code);
    faults() = {};
    expect_uploaded(200);
  }
}

TEST_F(SdoTransfers, AreAbortedOnTheBusWhenTheyAreCalledOff) {
  start();
  call_off_at = 7 * 127 * 2;
  EXPECT_EQ(download(50000).fault, SdoFault::cancelled);
  EXPECT_LT(cycles, 10);
  rig->run(2);
  const auto requests = rig->recorder.with(0x601);
  ASSERT_FALSE(requests.empty());
  EXPECT_EQ(requests.back().frame,
            make_frame(CobId::base(0x601), {0x80, 0x20, 0x20, 0x00, 0x00, 0x00, 0x00, 0x08}));
  call_off_at = 0xFFFF'FFFF;
  expect_downloaded(500);
}

TEST_F(SdoTransfers, StandFramesOfTheDeviceThatComeTwice) {
  start();
  sim::Fault twice;
  twice.kind = sim::FaultKind::duplicate;
  twice.node = 1_node;
  twice.probability = 1;
  twice.at = rig->world->now();
  rig->world->add(twice);
  for (const std::size_t size : {4U, 300U, 4U, 1000U}) {
    SCOPED_TRACE(size);
    expect_downloaded(size);
    expect_uploaded(size);
  }
}

TEST_F(SdoTransfers, SurviveALossyWire) {
  start();
  for (const double probability : {0.001, 0.01}) {
    sim::Fault loss;
    loss.kind = sim::FaultKind::loss;
    loss.node = std::nullopt;
    loss.probability = probability;
    loss.at = rig->world->now();
    loss.until = rig->world->now() + 10s;
    rig->world->add(loss);
    int good = 0;
    for (int i = 0; i < 10; ++i) {
      const Reply reply = download(2000);
      good += reply.fault == SdoFault::none;
      if (reply.fault == SdoFault::none) {
        EXPECT_EQ(stored(), some_bytes(2000));
      }
    }
    EXPECT_GE(good, 3);
    rig->world->advance_to(loss.until + 1ms);
  }
}

}  // namespace
}  // namespace takt
