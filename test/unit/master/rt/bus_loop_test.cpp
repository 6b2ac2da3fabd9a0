#include "master/rt/bus_loop.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <memory>

#include "test/unit/master/rt/bus_loop_rig.hpp"

namespace takt {
namespace {

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
  EXPECT_EQ(bus.port.calls.size(), 7U);  // no outputs, but a wait and a second receive()
  bus.run(9);
  EXPECT_EQ(bus.port.calls.size(), 7U);
  bus.run(1);
  EXPECT_EQ(bus.port.calls.size(), 5U);
}

TEST(BusLoop, PublishesALatePdoWhenItComes) {
  Loop bus;
  bus.run(100);
  ImageView image;
  while (bus.newest(image)) {
  }
  bus.port.answers[1].after = 900us;
  bus.run(1);
  ASSERT_TRUE(bus.newest(image));
  EXPECT_EQ(image.missing, 0U);
  EXPECT_EQ(image.publish_time - image.sync_time, 900us);

  bus.port.answers[1].after = 400us;
  bus.run(1);
  ASSERT_TRUE(bus.newest(image));
  EXPECT_LT(image.publish_time - image.sync_time, 430us);  // the next image is not late
}

TEST(BusLoop, IsWokenByFramesOfOthersAFewTimesOnly) {
  Loop bus;
  bus.run(100);
  ImageView image;
  while (bus.newest(image)) {
  }
  bus.port.answers[1].after = 5ms;  // this TPDO is missing
  for (int i = 0; i < 20; ++i) {
    bus.port.answers.push_back({make_frame(CobId::base(0x701), {5}), 500us + i * 20us});
  }
  bus.run(1);
  EXPECT_EQ(std::ranges::count(bus.port.calls, "wait"), 8);
  ASSERT_TRUE(bus.newest(image));
  EXPECT_EQ(image.missing, 1U);
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
  // A controller runs between publish and outputs of the same cycle.
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

/// Ten requests wait; each is answered after 250 us, and at most two are open at once.
std::size_t sent_in_one_cycle(bool booting) {
  Loop bus;
  bus.plan.cycle.service_frames = 2;
  for (std::size_t node = 0; node < 2; ++node) bus.network->set_up(node, !booting);
  bus.run(40);
  bus.port.on_sent = [&](const Frame& frame) {
    if (frame.id != CobId::base(0x601)) return;
    bus.port.inbox.push_back({make_frame(CobId::base(0x581), {0x60}), bus.port.now() + 250us});
  };
  bus.network->to_send.assign(10, make_frame(CobId::base(0x601), {0x40}));
  bus.port.sent.clear();
  bus.run(1);
  return bus.port.sent_with(0x601).size();
}

TEST(BusLoop, GivesAnAnswersPlaceToTheNextRequestWhileNobodyExchangesPdos) {
  EXPECT_EQ(sent_in_one_cycle(false), 2U);
  EXPECT_GT(sent_in_one_cycle(true), 6U);
  EXPECT_LE(sent_in_one_cycle(true), 10U);
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
  const auto events = bus.reported();
  EXPECT_EQ(std::ranges::count(events, EventKind::stopping), 1);
  EXPECT_EQ(std::ranges::count(events, EventKind::stopped), 1);
}

}  // namespace
}  // namespace takt
