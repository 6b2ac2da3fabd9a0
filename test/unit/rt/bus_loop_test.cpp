#include "master/rt/bus_loop.hpp"

#include <cerrno>
#include <gtest/gtest.h>
#include <memory>

#include "test/unit/rt/fake_port.hpp"
#include "test/unit/rt/small_plan.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::FakeNetwork;
using test::FakePort;

/// The loop over a scripted port; two axes at 2 ms that answer 300 and 400 us after SYNC.
class Loop {
 public:
  explicit Loop(BusPlan bus_plan = test::axes(), BusLoopOptions options = {})
      : plan{std::move(bus_plan)}, exchange{std::make_unique<Exchange>(plan)} {
    for (unsigned i = 0; i < plan.nodes.size(); ++i) {
      port.answers.push_back({make_frame(CobId::base(0x181 + i), {0x37, 0x02, 1, 0, 0, 0}),
                              Time{300us} + i * Time{100us}});
    }
    loop = std::make_unique<BusLoop<FakePort, FakeNetwork>>(plan, port, *exchange, options);
    network = FakeNetwork::newest;
    start = port.now();
    loop->start();
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      port.calls.clear();
      loop->cycle();
      most_calls = std::max(most_calls, port.calls.size());
    }
  }
  void command_all(std::int64_t controlword, std::int64_t target, std::uint32_t ttl = 0) {
    const std::size_t axes = plan.nodes.size();
    for (std::size_t i = 0; i < axes; ++i) {
      exchange->set_points.set(i, controlword, ttl);
      exchange->set_points.set(axes + i, target, ttl);
    }
    exchange->set_points.publish(port.now());
  }
  std::vector<EventKind> told() {
    std::vector<EventKind> all;
    for (Event event; exchange->events.pop(event);) all.push_back(event.kind);
    return all;
  }
  bool newest(ImageView& image) { return exchange->images.take_newest(image); }
  BusStatus status() {
    StatusSnapshot snapshot;
    exchange->status.read(snapshot);
    return snapshot.bus;
  }

  BusPlan plan;
  FakePort port;
  std::unique_ptr<Exchange> exchange;
  std::unique_ptr<BusLoop<FakePort, FakeNetwork>> loop;
  FakeNetwork* network = nullptr;
  Time start{};
  std::size_t most_calls = 0;
};

TEST(BusLoop, KeepsItsPhasesAndMakesSixCallsACycle) {
  Loop bus;
  bus.run(40);
  bus.command_all(0x0F, 7);
  bus.run(1);
  EXPECT_EQ(bus.port.calls,
            (std::vector<std::string>{"sleep", "send", "sleep", "receive", "sleep", "send"}));
  EXPECT_EQ(bus.most_calls, 6U);
}

TEST(BusLoop, SendsSyncOnTheBeatWithoutDrift) {
  Loop bus;
  bus.run(1000);
  const auto syncs = bus.port.sent_with(0x080);
  ASSERT_EQ(syncs.size(), 1000U);
  for (std::size_t k = 0; k < syncs.size(); ++k) {
    ASSERT_EQ(syncs[k].when, bus.start + static_cast<std::int64_t>(k + 1) * Time{2ms});
    ASSERT_EQ(syncs[k].frame.length, 0);
  }
}

TEST(BusLoop, CountsSyncFrom1ToTheOverflow) {
  BusPlan plan = test::axes();
  plan.cycle.sync_overflow = 3;
  Loop bus{plan};
  bus.run(7);
  std::vector<int> counters;
  for (const auto& sync : bus.port.sent_with(0x080)) counters.push_back(sync.frame.data[0]);
  EXPECT_EQ(counters, (std::vector<int>{1, 2, 3, 1, 2, 3, 1}));
  EXPECT_EQ(bus.port.sent.front().frame.length, 1);
}

TEST(BusLoop, PublishesAsSoonAsTheLastExpectedPdoIsThere) {
  Loop bus;
  bus.run(60);
  ImageView image;
  ASSERT_TRUE(bus.newest(image));
  EXPECT_EQ(image.values[0], 0x237);
  EXPECT_EQ(image.sync_time, bus.start + 60 * Time{2ms});
  EXPECT_GE(image.publish_time - image.sync_time, 400us);
  EXPECT_LT(image.publish_time - image.sync_time, 420us);
  EXPECT_EQ(image.missing, 0U);
  EXPECT_EQ(image.stale_bits[0], 0U);
}

TEST(BusLoop, LearnsALaterArrival) {
  Loop bus;
  bus.run(100);
  bus.port.answers[1].after = 600us;
  bus.run(1);
  EXPECT_EQ(bus.port.calls.size(), 7U);  // no outputs, but a second sleep and receive
  bus.run(1);
  EXPECT_EQ(bus.port.calls.size(), 5U);
}

TEST(BusLoop, ForgetsAnOldLateArrival) {
  Loop bus;
  bus.run(100);
  bus.port.answers[1].after = 900us;
  bus.run(2);
  bus.port.answers[1].after = 400us;
  bus.run(2000);
  ImageView image;
  while (bus.newest(image)) {
  }
  bus.run(1);
  ASSERT_TRUE(bus.newest(image));
  EXPECT_LT(image.publish_time - image.sync_time, 450us);
}

TEST(BusLoop, MakesAtMostEightCallsWithAMissingPdoAndTellsIt) {
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
  EXPECT_EQ(bus.port.calls.size(), 6U);  // nobody waits for the dead one any more
  const auto events = bus.told();
  EXPECT_EQ(std::ranges::count(events, EventKind::pdo_missing), 1);
}

TEST(BusLoop, SendsOutputsAtTheDeadlineForTheNextSync) {
  Loop bus;
  bus.run(1);
  bus.port.sent.clear();
  bus.command_all(0x0F, 7);
  bus.run(1);
  ASSERT_EQ(bus.port.sent.size(), 3U);
  EXPECT_EQ(bus.port.sent[1].when, bus.start + 4ms + 1600us);
  EXPECT_EQ(bus.port.sent[1].frame, make_frame(CobId::base(0x201), {0x0F, 0, 7, 0, 0, 0}));
  EXPECT_EQ(bus.port.sent[2].frame.id, CobId::base(0x202));
}

TEST(BusLoop, CommandMadeFromAnImageActsAtTheNextSync) {
  Loop bus;
  bus.run(3);
  ImageView image;
  ASSERT_TRUE(bus.newest(image));
  const std::uint64_t computed_from = image.cycle;
  // Between publish and outputs of the same cycle: the controller's place.
  struct Echo final : Controller {
    void update(const ImageView& in, OutputWriter& out) noexcept override {
      for (SignalIndex i = 4; i < 6; ++i) out.set(i, 0x0F);
      for (SignalIndex i = 6; i < 8; ++i) out.set(i, static_cast<std::int64_t>(in.cycle));
    }
  } echo;
  Loop with_controller{test::axes(), {.controller = &echo}};
  with_controller.run(5);
  const auto outputs = with_controller.port.sent_with(0x201);
  const auto syncs = with_controller.port.sent_with(0x080);
  ASSERT_EQ(outputs.size(), 5U);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(outputs[k].frame.data[2], k + 1);  // computed from image k + 1
    EXPECT_GT(outputs[k].when, syncs[k].when);
    EXPECT_LT(outputs[k].when, syncs[k].when + 2ms);
  }
  EXPECT_EQ(computed_from, 3U);
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
    EXPECT_EQ(syncs[k].frame.data[0], k + 1);                 // counts what was sent
  }
  EXPECT_EQ(syncs[10].when - syncs[9].when, 52ms);
  ImageView image;
  ASSERT_TRUE(bus.newest(image));
  EXPECT_EQ(image.cycle, 20U + 25U);
  EXPECT_EQ(image.beat, 20U);
  EXPECT_EQ(bus.status().cycles_missed, 25U);
  const auto events = bus.told();
  EXPECT_EQ(std::ranges::count(events, EventKind::cycles_missed), 1);
  EXPECT_EQ(std::ranges::count(events, EventKind::pdo_missing), 0);
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

TEST(BusLoop, InObserveModeSendsNothingAndShowsTheImage) {
  Loop bus{test::axes(), {.observe = true}};
  bus.network->to_send.push_back(make_frame(CobId::base(0x000), {1, 0}));
  bus.command_all(0x0F, 7);
  Request request;
  request.id = 9;
  bus.exchange->requests.push(request);
  for (int i = 0; i < 20; ++i) {
    bus.port.inbox.push_back(
        {make_frame(CobId::base(0x181), {0x21, 0, 0, 0, 0, 0}), bus.port.now() + 500us});
    bus.run(1);
  }
  EXPECT_TRUE(bus.port.sent.empty());
  ImageView image;
  ASSERT_TRUE(bus.newest(image));
  EXPECT_EQ(image.values[0], 0x21);
  Reply reply;
  ASSERT_TRUE(bus.exchange->replies.pop(reply));
  EXPECT_EQ(reply.id, 9U);
  EXPECT_EQ(reply.fault, SdoFault::cancelled);
}

TEST(BusLoop, WithoutSyncHasAPeriodOfItsOwn) {
  BusPlan plan = test::axes({.tpdo_type = 255});
  plan.cycle.sync = false;
  Loop bus{plan};
  bus.run(10);
  EXPECT_TRUE(bus.port.sent.empty());
  ImageView image;
  ASSERT_TRUE(bus.newest(image));
  EXPECT_EQ(image.cycle, 10U);
}

TEST(BusLoop, SendsServiceFramesInTheSlackWithinTheirBudget) {
  Loop bus;
  bus.plan.cycle.service_frames = 4;
  bus.run(40);
  for (int i = 0; i < 10; ++i) {
    bus.network->to_send.push_back(make_frame(CobId::base(0x000), {1, 1}));
  }
  bus.port.sent.clear();
  bus.run(1);
  const auto first = bus.port.sent_with(0x000);
  ASSERT_EQ(first.size(), 4U);
  EXPECT_GE(first[0].when - bus.start, 82ms);
  EXPECT_LT(first[3].when - bus.start, 82ms + 1600us);
  bus.run(2);
  EXPECT_EQ(bus.port.sent_with(0x000).size(), 10U);
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

TEST(BusLoop, TakesTheAnswerToAnSdoInTheSlack) {
  Loop bus;
  bus.run(40);
  bus.port.on_sent = [&](const Frame& frame) {
    if (frame.id != CobId::base(0x601)) return;
    bus.port.inbox.push_back({make_frame(CobId::base(0x581), {0x60}), bus.port.now() + 250us});
  };
  bus.network->to_send.push_back(make_frame(CobId::base(0x601), {0x40}));
  bus.run(1);
  ASSERT_EQ(bus.network->heard.size(), 1U);
  EXPECT_EQ(bus.network->heard[0].id, CobId::base(0x581));
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

TEST(BusLoop, TellsAFullSendBufferWithItsCauseOnceASecond) {
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
  EXPECT_EQ(full[0].detail, static_cast<std::uint32_t>(SendTrouble::nobody_acknowledges));
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
  EXPECT_TRUE(bus.told().empty());

  bus.network->set_up(1, true);  // back: its old command is not sent again
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

TEST(BusLoop, StopsInOrder) {
  Loop bus;
  for (auto& answer : bus.port.answers) answer.frame.data = {0x27, 0x02};  // enabled
  bus.command_all(0x0F, 7, 1000);
  bus.run(20);
  bus.port.sent.clear();
  bus.loop->request_stop();
  int cycles = 0;
  for (; !bus.loop->done() && cycles < 5000; ++cycles) {
    if (cycles == 20) bus.port.answers[0].frame.data = {0x40, 0x02};
    if (cycles == 30) bus.port.answers[1].frame.data = {0x40, 0x02};
    bus.run(1);
  }
  EXPECT_GT(cycles, 30);
  EXPECT_LT(cycles, 40);
  EXPECT_EQ(bus.port.sent_with(0x201).front().frame.data[0], 0x02);
  EXPECT_TRUE(bus.network->stopping);
  EXPECT_TRUE(bus.exchange->finished);
  const auto events = bus.told();
  EXPECT_EQ(std::ranges::count(events, EventKind::stopping), 1);
  EXPECT_EQ(std::ranges::count(events, EventKind::stopped), 1);
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
