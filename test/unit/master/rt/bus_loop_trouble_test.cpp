#include <cerrno>
#include <gtest/gtest.h>

#include "test/unit/master/rt/bus_loop_rig.hpp"

namespace takt {
namespace {

TEST(BusLoop, MakesAtMostEightCallsWithAMissingPdoAndReportsIt) {
  Loop bus;
  bus.command_all(0x0F, 7);
  bus.run(50);
  bus.most_calls = 0;
  bus.port.answers.pop_back();
  bus.command_all(0x0F, 7, 1000);
  bus.run(2);
  EXPECT_EQ(bus.port.calls.size(), 8U);
  ImageView image;
  ASSERT_TRUE(bus.newest(image));
  EXPECT_EQ(image.missing, 1U);
  EXPECT_EQ(image.stale_bits[0], 0b1010U);
  EXPECT_EQ(image.publish_time - image.sync_time, 1200us);  // the receive window

  bus.run(20);
  EXPECT_EQ(bus.most_calls, 8U);
  EXPECT_EQ(bus.port.calls.size(), 6U);  // the loop no longer waits for the dead node
  const auto events = bus.reported();
  EXPECT_EQ(std::ranges::count(events, EventKind::pdo_missing), 1);
}

TEST(BusLoop, AfterAStallOf50MsSendsNoBurst) {
  BusPlan plan = test::axes();
  plan.cycle.sync_overflow = 240;
  Loop bus{plan};
  bus.run(10);
  bus.port.stall = 50ms;
  bus.run(10);

  const auto syncs = bus.port.sent_with(0x080);
  ASSERT_EQ(syncs.size(), 20U);
  for (std::size_t k = 1; k < syncs.size(); ++k) {
    EXPECT_GE(syncs[k].when - syncs[k - 1].when, 1ms);
    EXPECT_EQ((syncs[k].when - bus.start) % Time{2ms}, 0ns);  // the phase is kept
    EXPECT_EQ(syncs[k].frame.data[0], k + 1);  // counts only the SYNCs that were sent
  }
  EXPECT_EQ(syncs[10].when - syncs[9].when, 52ms);
  ImageView image;
  ASSERT_TRUE(bus.newest(image));
  EXPECT_EQ(image.cycle, 20U + 25U);
  EXPECT_EQ(image.beat, 20U);
  EXPECT_EQ(bus.status().cycles_missed, 25U);
  const auto events = bus.reported();
  EXPECT_EQ(std::ranges::count(events, EventKind::cycles_missed), 1);
  EXPECT_EQ(std::ranges::count(events, EventKind::pdo_missing), 0);
}

TEST(BusLoop, CountsASyncThatWasLeftOutAsLateByThePeriodsThatItMissed) {
  Loop bus;
  bus.run(10);
  EXPECT_LT(bus.exchange->timing.sync_lateness.snapshot().maximum(), 1us);

  bus.port.stall = 1100us;  // more than half a period: this SYNC is not sent
  bus.run(1);
  EXPECT_GE(bus.exchange->timing.sync_lateness.snapshot().maximum(), 2ms);

  bus.port.stall = 50ms;
  bus.run(1);
  EXPECT_GE(bus.exchange->timing.sync_lateness.snapshot().maximum(), 50ms);
}

TEST(BusLoop, ExcusesTheNodesForTheTimeOfItsOwnAbsence) {
  Loop bus;
  bus.run(10);
  EXPECT_TRUE(FakeNetwork::newest->absences.empty());
  bus.port.stall = 400ms;
  bus.run(10);
  EXPECT_EQ(FakeNetwork::newest->absences, std::vector<Time>{400ms});
}

TEST(BusLoop, ExcusesTheAnswersToPdoRequestsForTheTimeOfItsOwnAbsence) {
  Loop bus;
  bus.port.answers.clear();
  bus.exchange->requests.push(
      {.id = 1, .kind = RequestKind::pdo_poll, .node = 1, .object = {1, 0}, .timeout = 100ms});
  bus.run(2);
  bus.port.stall = 400ms;
  bus.run(10);
  Reply reply;
  EXPECT_FALSE(bus.exchange->replies.pop(reply));
  bus.run(50);
  ASSERT_TRUE(bus.exchange->replies.pop(reply));
  EXPECT_EQ(reply.fault, SdoFault::timeout);
}

TEST(BusLoop, SendsALateSyncButKeepsHalfAPeriodToTheNext) {
  Loop bus;
  bus.run(5);
  bus.port.stall = 900us;
  bus.run(1);
  bus.port.stall = 1100us;
  bus.run(2);
  const auto syncs = bus.port.sent_with(0x080);
  EXPECT_EQ(syncs[5].when - bus.start, 12ms + 900us);
  EXPECT_EQ(syncs[6].when - bus.start, 16ms);  // 14 ms was left out
  bus.run(6);
  EXPECT_EQ(bus.status().cycles_missed, 1U);
  EXPECT_EQ(bus.status().cycles_late, 1U);
}

TEST(BusLoop, TwoStallsInARowMakeNoBurstOfSyncs) {
  Loop bus;
  bus.run(3);

  bus.port.stall = 50ms;
  bus.port.second_stall = 3900us;  // of a period of 2 ms: nearly two
  bus.run(3);

  const auto syncs = bus.port.sent_with(0x080);
  ASSERT_EQ(syncs.size(), 6U);
  for (std::size_t i = 1; i < syncs.size(); ++i) {
    EXPECT_GE(syncs[i].when - syncs[i - 1].when, 1ms);
  }
}

/// The front thread sleeps until the predicted image. With an old prediction it would look for
/// images only every 20 ms.
TEST(BusLoop, AfterAStallWithinACyclePredictsTheNextImage) {
  Loop bus;
  bus.run(5);

  bus.port.receive_stall = 50ms;
  bus.run(1);
  const Time predicted{bus.exchange->next_publish.load()};
  bus.run(1);

  ImageView image;
  ASSERT_TRUE(bus.newest(image));
  EXPECT_GE(predicted, image.publish_time - 500us);
  EXPECT_LE(predicted, image.publish_time + 500us);
}

TEST(BusLoop, CommandOlderThanItsTimeToLiveFallsBack) {
  Loop bus;
  bus.run(1);
  bus.command_all(0x0F, 7);
  bus.run(6);
  const auto outputs = bus.port.sent_with(0x201);
  ASSERT_EQ(outputs.size(), 6U);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(outputs[k].frame.data[0], k < 3 ? 0x0F : 0x02);
}

TEST(BusLoop, LetsServicesThroughEvenWhereTheCycleHasNoSlack) {
  BusPlan plan = test::axes();
  plan.cycle.receive_window = plan.cycle.output_deadline = 1600us;
  Loop bus{plan};
  for (auto& answer : bus.port.answers) answer.after += 1100us;
  bus.run(100);
  bus.port.sent.clear();
  for (int i = 0; i < 5; ++i) {
    bus.network->to_send.push_back(make_frame(CobId::base(0x601), {0x40}));
  }
  bus.run(20);
  const auto requests = bus.port.sent_with(0x601);
  ASSERT_EQ(requests.size(), 5U);
  for (const auto& request : requests) {
    EXPECT_EQ((request.when - bus.start) % Time{2ms}, 0ns);  // right behind SYNC
  }
}

TEST(BusLoop, LeavesOutOutputsThatCouldNotEndBeforeTheNextSync) {
  Loop bus{test::axes({.fallback_cycles = 0})};
  bus.run(1);
  bus.command_all(0x0F, 7, 100);
  bus.plan.cycle.output_deadline = 1900us;  // two frames take up to 230 us
  bus.run(1);
  EXPECT_TRUE(bus.port.sent_with(0x201).empty());
  bus.plan.cycle.output_deadline = 1600us;
  bus.run(10);
  EXPECT_EQ(bus.port.sent_with(0x201).size(), 10U);
  EXPECT_EQ(bus.status().outputs_skipped, 1U);
}

TEST(BusLoop, EventDrivenOutputsThatDoNotAllFitTakeTurns) {
  BusPlan plan = test::axes({.nodes = 5, .fallback_cycles = 0});
  for (std::size_t i = 2; i < 5; ++i) plan.pdos.rpdos[i].transmission = 255;
  Loop bus{plan};
  bus.run(1);
  // Room for three frames of up to 115 us: the two synchronous ones and one other.
  bus.plan.cycle.output_deadline = 1640us;
  const auto sent = [&](unsigned node) { return bus.port.sent_with(0x200 + node).size(); };
  bus.command_all(0x0F, 7, 100);
  for (const unsigned node : {3U, 4U, 5U}) {
    bus.run(1);
    EXPECT_EQ(sent(node), 1U) << node;
  }
  EXPECT_EQ(sent(1), 3U);
  EXPECT_EQ(sent(2), 3U);
  EXPECT_EQ(sent(3) + sent(4) + sent(5), 3U);
  EXPECT_EQ(bus.status().outputs_skipped, 0U);
}

TEST(BusLoop, ReportsAFullSendBufferWithItsCauseOnceASecond) {
  Loop bus;
  bus.run(1);
  bus.command_all(0x0F, 7, 1000);
  bus.port.room = 1;
  bus.port.error = ENOBUFS;
  bus.port.news_now.error_passive = true;
  bus.run(20);
  std::vector<Event> full;
  for (Event event; bus.exchange->events.pop(event);) {
    if (event.kind == EventKind::send_buffer_full) full.push_back(event);
  }
  ASSERT_EQ(full.size(), 1U);
  EXPECT_EQ(full[0].value, 1);
  EXPECT_EQ(full[0].detail, static_cast<std::uint32_t>(SendFailure::nobody_acknowledges));
}

TEST(BusLoop, CountsTheEventsThatFoundNoRoomInTheServicesToo) {
  Loop bus;
  bus.network->lost_events = 3;
  bus.run(10);
  EXPECT_EQ(bus.status().events_lost, 3U);
}

TEST(BusLoop, SendsSyncAtOnceWhereAnInterfaceIsBackThatTookOneDownWithIt) {
  Loop bus;
  bus.port.news_now.last_sync_echo = bus.start;
  bus.run(10);  // without an echo, SYNC is held and tried at growing intervals
  bus.port.news_now.interface_down = true;
  bus.port.room = 0;
  bus.port.error = ENETDOWN;
  bus.run(30000);  // a minute
  bus.port.sent.clear();

  bus.port.news_now.interface_down = false;
  bus.port.room = 1000;
  bus.run(1);

  EXPECT_EQ(bus.port.sent_with(0x080).size(), 1U);
}

TEST(BusLoop, ANodeThatIsOffDoesNotDisturbTheOthers) {
  Loop bus{test::axes({.fallback_cycles = 0})};
  bus.run(1);
  bus.command_all(0x0F, 7, 1000);
  bus.run(50);
  bus.network->set_up(1, false);
  bus.port.answers.pop_back();
  bus.port.sent.clear();
  bus.run(50);
  EXPECT_EQ(bus.port.sent_with(0x201).size(), 50U);
  EXPECT_EQ(bus.port.sent_with(0x202).size(), 0U);
  EXPECT_TRUE(bus.reported().empty());

  bus.network->set_up(1, true);  // the node is back; its old command is not sent again
  bus.run(5);
  EXPECT_EQ(bus.port.sent_with(0x202).size(), 0U);
}

TEST(BusLoop, AnswersEveryRequestOnceEvenWithAFullReplyRing) {
  Loop bus;
  std::uint64_t asked = 0;
  std::vector<std::uint64_t> answered;
  for (int i = 0; i < 60; ++i) {
    Request request;
    request.id = asked + 1;
    if (bus.exchange->requests.push(request)) ++asked;
    bus.network->refuse = i % 3 == 0;
    bus.run(1);
    if (i < 30) continue;  // the front thread sleeps
    for (Reply reply; bus.exchange->replies.pop(reply);) answered.push_back(reply.id);
  }
  bus.run(40);
  for (Reply reply; bus.exchange->replies.pop(reply);) answered.push_back(reply.id);
  ASSERT_EQ(answered.size(), asked);
  std::ranges::sort(answered);
  for (std::uint64_t i = 0; i < asked; ++i) EXPECT_EQ(answered[i], i + 1);
}

TEST(BusLoop, CancelsPdoRequestsThatComeWhileItStops) {
  Loop bus;
  bus.run(2);
  bus.loop->request_stop();
  bus.run(1);
  bus.exchange->requests.push(
      {.id = 1, .kind = RequestKind::pdo_poll, .node = 1, .object = {1, 0}});
  bus.run(1);

  Reply reply;
  ASSERT_TRUE(bus.exchange->replies.pop(reply));
  EXPECT_EQ(reply.fault, SdoFault::cancelled);
  const auto asked = bus.port.sent_with(0x181);
  EXPECT_TRUE(asked.empty());
}

TEST(BusLoop, StopsWithinItsTimeWhenAnAxisStaysEnabled) {
  Loop bus;
  bus.port.answers[0].frame.data = {0x27, 0x02};
  bus.command_all(0x0F, 7, 1000);
  bus.run(20);
  bus.loop->request_stop();
  const Time begun = bus.port.now();
  while (!bus.loop->done()) bus.run(1);
  EXPECT_LE(bus.port.now() - begun, bus.plan.stop_timeout);
  EXPECT_EQ(bus.port.sent_with(0x201).back().frame.data[0], 0x00);  // disable voltage at last
}

}  // namespace
}  // namespace takt
