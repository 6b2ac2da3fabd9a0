#include <atomic>
#include <cerrno>
#include <gtest/gtest.h>
#include <memory>
#include <thread>
#include <vector>

#include "master/rt/arrival_prediction.hpp"
#include "master/rt/beat/beat_clock.hpp"
#include "master/rt/beat/sync_gate.hpp"
#include "master/rt/exchange/histogram.hpp"
#include "master/rt/exchange/spsc_ring.hpp"
#include "master/rt/exchange/status_board.hpp"
#include "master/rt/machines/service_queue.hpp"
#include "master/rt/port_watch.hpp"
#include "master/wire/wire_time.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

TEST(BeatClock, LeavesOutMissedPeriodsAndKeepsThePhase) {
  BeatClock clock{2ms};
  clock.start(10ms);
  EXPECT_EQ(clock.skip_missed(11ms), 0U);  // half a period: still sent
  EXPECT_EQ(clock.skip_missed(11ms + 1ns), 1U);
  EXPECT_EQ(clock.deadline(), 12ms);
  EXPECT_EQ(clock.skip_missed(62ms), 25U);
  EXPECT_EQ(clock.deadline(), 62ms);
  EXPECT_EQ(clock.cycle(), 27U);
}

TEST(SyncCounter, RunsFrom1To240AndAgain) {
  SyncCounter counter{240};
  for (int i = 1; i <= 240; ++i, counter.sent()) EXPECT_EQ(counter.next(), i);
  EXPECT_EQ(counter.next(), 1);
  EXPECT_FALSE(SyncCounter{0}.used());
  EXPECT_FALSE(SyncCounter{1}.used());
  EXPECT_TRUE(SyncCounter{2}.used());
}

TEST(ArrivalPrediction, WaitsForTheWindowUntilItHasLearned) {
  ArrivalPrediction prediction{1200us};
  for (int i = 0; i < 15; ++i) prediction.in_time(400us);
  EXPECT_EQ(prediction.predicted(), 1200us);
  prediction.in_time(410us);
  EXPECT_EQ(prediction.predicted(), 415us);
}

TEST(ArrivalPrediction, NeverGoesBeyondTheWindow) {
  ArrivalPrediction prediction{1200us};
  for (int i = 0; i < 16; ++i) prediction.in_time(1199us);
  EXPECT_EQ(prediction.predicted(), 1200us);
  prediction.late(5ms);
  EXPECT_EQ(prediction.predicted(), 1200us);
}

ArrivalPrediction learned(Time arrival) {
  ArrivalPrediction prediction{1200us};
  for (int i = 0; i < 16; ++i) prediction.in_time(arrival);
  return prediction;
}

TEST(ArrivalPrediction, OfOneLatePdoDoesNotMakeTheNextImagesLate) {
  ArrivalPrediction prediction = learned(400us);
  prediction.late(1100us);
  EXPECT_EQ(prediction.predicted(), 425us);
  prediction.late(426us);
  EXPECT_EQ(prediction.predicted(), 431us);
}

TEST(ArrivalPrediction, FollowsArrivalsThatStayLaterOrEarlier) {
  ArrivalPrediction prediction = learned(400us);
  int late = 0;
  for (; prediction.predicted() < 1000us; ++late) prediction.late(1000us);
  EXPECT_EQ(late, 30);
  EXPECT_EQ(prediction.predicted(), 1005us);
  for (int i = 0; i < 2000; ++i) prediction.in_time(400us);
  EXPECT_LT(prediction.predicted(), 410us);
}

TEST(WireTime, KnowsTheWorstCaseOfTheLimits) {
  const WireTime fast{1'000'000};
  const Frame eight = make_frame(CobId::base(0x181), {1, 2, 3, 4, 5, 6, 7, 8});
  const Frame sync{.id = CobId::base(0x080)};
  EXPECT_EQ(fast.worst({&eight, 1}), 135us);
  EXPECT_EQ(fast.worst({&sync, 1}), 55us);
  EXPECT_EQ(WireTime{250'000}.worst({&eight, 1}), 540us);
}

TEST(WireTime, OfARemoteFrameHasNoData) {
  const Frame remote{.id = CobId::base(0x181), .length = 8, .rtr = true};
  EXPECT_EQ(WireTime::worst_bits(remote), 55);
  EXPECT_EQ(WireTime::mean_bits(remote), 48);
}

TEST(Histogram, PutsTimesIntoBinsOfAnEighthOctave) {
  EXPECT_EQ(Histogram::bin_of(-5us), 0U);
  EXPECT_EQ(Histogram::bin_of(0ns), 0U);
  for (const Time time :
       std::vector<Time>{1ns, 100ns, 124ns, 125ns, 999ns, 1us, 7us, 100us, 3ms, 9s}) {
    const std::size_t bin = Histogram::bin_of(time);
    EXPECT_LT(time, Histogram::upper_edge(bin)) << time.count();
    EXPECT_TRUE(bin == 0 || time >= Histogram::upper_edge(bin - 1)) << time.count();
  }
  EXPECT_EQ(Histogram::bin_of(100h), HistogramSnapshot::bins - 1);
}

TEST(Histogram, ReportsPercentilesAndOctaves) {
  auto histogram = std::make_unique<Histogram>();
  for (int i = 0; i < 99; ++i) histogram->record(10us);
  const HistogramSnapshot before = histogram->snapshot();
  histogram->record(1ms);
  const HistogramSnapshot all = histogram->snapshot();
  EXPECT_EQ(all.total(), 100U);
  EXPECT_GE(all.percentile(0.5), 10us);
  EXPECT_LE(all.percentile(0.5), 11250ns);
  EXPECT_GE(all.maximum(), 1ms);
  EXPECT_EQ((all - before).total(), 1U);
  EXPECT_GE((all - before).minimum(), 1ms);
  // 10 us = 80 * 125 ns: octave 6; 1 ms = 8000 * 125 ns: octave 12
  EXPECT_EQ(all.by_octave()[6], 99U);
  EXPECT_EQ(all.by_octave()[12], 1U);
}

TEST(SyncGate, HoldsWhileTheNewestSyncIsNotOnTheWire) {
  SyncGate gate{2ms};
  EXPECT_TRUE(gate.open({.last_sync_echo = 1s}, 1s));
  gate.sent(2s);
  EXPECT_FALSE(gate.open({.last_sync_echo = 1s}, 2002ms));
  EXPECT_FALSE(gate.open({.last_sync_echo = 1s}, 2004ms));
  EXPECT_TRUE(gate.open({.last_sync_echo = 2s}, 2006ms));
}

TEST(SyncGate, TriesAgainEverLessOftenWhereTheEchoStaysAway) {
  SyncGate gate{2ms};
  gate.sent(1s);
  int tries = 0;
  for (Time now = 1s; now < 11s; now += 2ms) {
    if (!gate.open({.last_sync_echo = 1ms}, now)) continue;
    gate.sent(now);
    ++tries;
  }
  EXPECT_EQ(tries, 6);  // after 0.1, 0.3, 0.7, 1.5, 3.1, 6.3 s
}

TEST(SyncGate, IsHeldByBusOffAlone) {
  SyncGate gate{2ms};
  EXPECT_TRUE(gate.open({}, 1s));
  for (Time now = 1s; now < 9s; now += 10ms) EXPECT_FALSE(gate.open({.bus_off = true}, now));
  EXPECT_TRUE(gate.open({}, 10s));
}

TEST(SyncGate, ForgetsTheSyncThatAnInterfaceTookDownWithIt) {
  SyncGate gate{2ms};
  gate.sent(1s);
  PortCondition condition{.bus_off = true, .last_sync_echo = 1ms};
  EXPECT_FALSE(gate.open(condition, 1002ms));

  condition.interface_down = true;
  for (Time now = 1004ms; now < 61s; now += 2ms) EXPECT_TRUE(gate.open(condition, now));

  condition.interface_down = condition.bus_off = false;
  EXPECT_TRUE(gate.open(condition, 61s));
  gate.sent(61s);
  EXPECT_FALSE(gate.open(condition, 61s + 2ms));  // a new doubt begins with the shortest pause
  EXPECT_TRUE(gate.open(condition, 61s + 102ms));
}

TEST(SyncGate, KnowsNoDoubtWithoutEchoes) {
  SyncGate gate{2ms};
  gate.sent(1s);
  EXPECT_TRUE(gate.open({}, 2s));
}

TEST(ServiceQueue, SendsInOrderWhatIsLeft) {
  auto queue = std::make_unique<ServiceQueue>();
  for (std::uint8_t i = 0; i < 10; ++i) queue->inbox().push(make_frame(CobId::base(0), {i}));
  queue->drop(4);
  ASSERT_EQ(queue->size(), 6U);
  EXPECT_EQ(queue->first(2)[0].data[0], 4);
  queue->drop(6);
  EXPECT_TRUE(queue->empty());
}

std::vector<EventKind> drain(EventQueue& events) {
  std::vector<EventKind> kinds;
  for (Event event; events.pop(event);) kinds.push_back(event.kind);
  return kinds;
}

TEST(PortWatch, ReportsEachChangeOnce) {
  auto events = std::make_unique<EventQueue>();
  PortWatch watch{*events};
  watch.on_condition({}, 0ms);
  EXPECT_TRUE(drain(*events).empty());
  watch.on_condition({.error_passive = true}, 1ms);
  watch.on_condition({.error_passive = true}, 2ms);
  EXPECT_EQ(drain(*events), std::vector{EventKind::bus_error_passive});
  watch.on_condition({.error_passive = true, .bus_off = true}, 3ms);
  watch.on_condition({}, 4ms);
  EXPECT_EQ(drain(*events), (std::vector{EventKind::bus_off, EventKind::bus_recovered,
                                         EventKind::bus_error_active}));
  watch.on_condition({.interface_down = true, .last_error = ENETDOWN}, 5ms);
  watch.on_condition({.receive_overruns = 7}, 6ms);
  EXPECT_EQ(drain(*events), (std::vector{EventKind::interface_down, EventKind::interface_up,
                                         EventKind::receive_overrun}));
}

TEST(PortWatch, GivesTheErrorOfAnInterfaceOnlyWhileItIsDown) {
  auto events = std::make_unique<EventQueue>();
  PortWatch watch{*events};
  watch.on_condition({.interface_down = true, .last_error = ENETDOWN}, 1ms);
  watch.on_condition({.last_error = ENETDOWN}, 2ms);
  Event event;
  ASSERT_TRUE(events->pop(event));
  EXPECT_EQ(event.kind, EventKind::interface_down);
  EXPECT_EQ(event.detail, static_cast<std::uint32_t>(ENETDOWN));
  ASSERT_TRUE(events->pop(event));
  EXPECT_EQ(event.kind, EventKind::interface_up);
  EXPECT_EQ(event.detail, 0U);
}

TEST(PortWatch, NamesTheCauseOfAFullBuffer) {
  auto events = std::make_unique<EventQueue>();
  PortWatch watch{*events};
  watch.on_send(3, ENETDOWN, 0ms);
  EXPECT_TRUE(events->empty());
  watch.on_send(3, ENOBUFS, 0ms);
  watch.on_send(3, ENOBUFS, 500ms);
  watch.on_condition({.bus_off = true}, 600ms);
  watch.on_send(3, ENOBUFS, 1s);
  std::vector<std::uint32_t> causes;
  for (Event event; events->pop(event);) {
    if (event.kind == EventKind::send_buffer_full) causes.push_back(event.detail);
  }
  EXPECT_EQ(causes, (std::vector{static_cast<std::uint32_t>(SendFailure::queue_too_short),
                                 static_cast<std::uint32_t>(SendFailure::bus_off)}));
}

TEST(SpscRing, IsFullExactlyWhenPushRefuses) {
  SpscRing<int, 4> ring;
  for (int i = 0; i < 4; ++i) {
    EXPECT_FALSE(ring.full());
    EXPECT_TRUE(ring.push(i));
  }
  EXPECT_TRUE(ring.full());
  EXPECT_FALSE(ring.push(4));
  EXPECT_EQ(ring.overruns(), 1U);
  int item = 0;
  EXPECT_TRUE(ring.pop(item));
  EXPECT_FALSE(ring.full());
}

TEST(SpscRing, HasRoomForAsManyItemsAsItTakes) {
  SpscRing<int, 4> ring;
  int item = 0;
  for (int laps = 0; laps < 3; ++laps) {
    EXPECT_TRUE(ring.has_room(4));
    EXPECT_TRUE(ring.push(1) && ring.push(2));
    EXPECT_TRUE(ring.has_room(2));
    EXPECT_FALSE(ring.has_room(3));
    EXPECT_TRUE(ring.pop(item) && ring.pop(item));
  }
}

TEST(SpscRing, LosesNothingBetweenTwoThreads) {
  auto ring = std::make_unique<SpscRing<std::uint64_t, 16>>();
  std::thread producer{[&] {
    for (std::uint64_t i = 1; i <= 50000;) {
      if (!ring->full() && ring->push(i)) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  }};
  for (std::uint64_t expected = 1; expected <= 50000;) {
    std::uint64_t item = 0;
    if (!ring->pop(item)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_EQ(item, expected);
    ++expected;
  }
  producer.join();
}

TEST(StatusBoard, IsConsistentBetweenTwoThreads) {
  StatusBoard board{3, 2};
  std::atomic<bool> done{false};
  std::thread bus{[&] {
    std::vector<NodeStatus> nodes(3);
    for (std::uint32_t i = 1; i <= 20000; ++i) {
      for (NodeStatus& node : nodes) node.boot_count = i;
      BusStatus status;
      status.cycle = i;
      board.write(
          status, nodes, [&](std::size_t) { return PdoStatus{.received = i}; },
          [](std::size_t) { return RpdoStatus{}; });
    }
    done = true;
  }};
  StatusSnapshot snapshot;
  for (bool last = false; !last;) {
    last = done;
    board.read(snapshot);
    for (const NodeStatus& node : snapshot.nodes) ASSERT_EQ(node.boot_count, snapshot.bus.cycle);
    for (const PdoStatus& pdo : snapshot.tpdos) ASSERT_EQ(pdo.received, snapshot.bus.cycle);
  }
  bus.join();
  EXPECT_EQ(snapshot.bus.cycle, 20000U);
}

TEST(StatusBoard, KeepsTheNodesThatAreNotWritten) {
  StatusBoard board{3, 0};
  std::vector<NodeStatus> nodes(3);
  const auto write = [&](std::size_t count, std::uint32_t boots) {
    for (NodeStatus& node : nodes) node.boot_count = boots;
    board.write(
        {}, std::span{nodes}.first(count), [](std::size_t) { return PdoStatus{}; },
        [](std::size_t) { return RpdoStatus{}; });
  };
  EXPECT_EQ(board.version(), 0U);
  write(3, 7);
  const std::uint64_t first = board.version();
  write(2, 8);
  EXPECT_NE(board.version(), first);

  StatusSnapshot snapshot;
  board.read(snapshot);
  ASSERT_EQ(snapshot.nodes.size(), 3U);
  EXPECT_EQ(snapshot.nodes[1].boot_count, 8U);
  EXPECT_EQ(snapshot.nodes[2].boot_count, 7U);
}

}  // namespace
}  // namespace takt
