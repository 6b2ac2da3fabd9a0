// What the front thread does after a time in which it did not run.
#include <algorithm>
#include <deque>
#include <gtest/gtest.h>
#include <utility>

#include "master/gateway/bridge.hpp"
#include "test/unit/master/gateway/rig_clocks.hpp"
#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// The messages that wait in the sockets of the front thread, and the messages that it has sent.
class Waiting final : public Transport {
 public:
  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    if (const auto image = decode<image_t>(data)) images.push_back(image->cycle);
    if (const auto reply = decode<reply_t>(data)) replies.push_back(reply->text);
    if (const auto state = decode<transfer_state_t>(data)) transfers.push_back(*state);
    static_cast<void>(channel);
    return true;
  }
  void subscribe(const std::string&) override {}
  void serve(const MessageHandler& handler) override {
    for (std::size_t i = 0; i < budget && !waiting.empty(); ++i) {
      const auto [channel, bytes] = waiting.front();
      waiting.pop_front();
      handler(channel, bytes);
    }
  }
  bool drained() const override { return waiting.empty(); }
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return {}; }

  template <class T>
  void arrive(const std::string& channel, const T& message) {
    std::vector<std::byte> bytes;
    encode(message, bytes);
    waiting.emplace_back(channel, bytes);
  }

  std::size_t budget = 1000;  // messages in each round
  std::deque<std::pair<std::string, std::vector<std::byte>>> waiting;
  std::vector<std::int64_t> images;
  std::vector<std::string> replies;
  std::vector<transfer_state_t> transfers;
};

class StoppedDaemon : public testing::Test {
 protected:
  explicit StoppedDaemon(std::uint32_t fallback_cycles = 5)
      : rig{test::axes({.nodes = 1, .period = 4ms, .fallback_cycles = fallback_cycles})} {
    EXPECT_TRUE(rig.boot());
    for (int i = 0; i < 5; ++i) cycle();
  }

  void cycle() {
    rig.master->cycle();
    bridge.serve();
  }
  command_t command(std::int64_t value) {
    command_t made{};
    made.schema = message_schema;
    made.session = 7;
    made.instance = 1;
    made.sender = "app";
    made.cycle = lcm.images.back();
    made.time_to_live = 5;
    made.signals = {static_cast<std::int32_t>(rig.master->plan().layout.inputs)};
    made.values = {value};
    made.num_values = 1;
    return made;
  }

  std::uint64_t refused(CommandRefusal reason) const {
    return bridge.refusals()[std::to_underlying(reason)];
  }
  request_t request(std::int64_t id) {
    request_t made{};
    made.schema = message_schema;
    made.service = "emcy_history";
    made.node_id = 1;
    made.id = id;
    made.utime = clocks.now() / std::chrono::microseconds{1};
    return made;
  }

  test::Rig rig;
  test::RigClocks clocks{rig};
  Waiting lcm;
  std::vector<std::string> reported;
  Bridge bridge{*rig.master,
                lcm,
                clocks,
                {.session = 7, .interface = {}, .realtime = {}},
                [this](const Notice& notice) {
                  reported.push_back(notice.kind);
                  if (notice.kind == "fallback_begun") fallback = notice.text;
                }};
  std::string fallback;  // text of the fallback
};

TEST_F(StoppedDaemon, ActsOnNoCommandThatWaited) {
  lcm.arrive(bridge.channels().command, command(6));
  cycle();
  ASSERT_EQ(bridge.commands_taken(), 1U);

  for (int i = 0; i < 20; ++i) lcm.arrive(bridge.channels().command, command(15));
  rig.world->advance_to(rig.world->now() +
                        10s);  // the daemon does not run, and the application dies
  bridge.serve();
  for (int i = 0; i < 5; ++i) cycle();

  EXPECT_EQ(bridge.commands_taken(), 1U);
  EXPECT_EQ(bridge.commands_refused(), 20U);
  EXPECT_EQ(std::ranges::count(reported, "front_gap"), 1);
}

TEST_F(StoppedDaemon, DiscardsEverythingThatWaitedHoweverLongTheBacklogIs) {
  for (int i = 0; i < 500; ++i) lcm.arrive(bridge.channels().command, command(15));
  lcm.arrive(bridge.channels().request, request(77));
  lcm.budget = 10;
  rig.world->advance_to(rig.world->now() + 6s);
  for (int i = 0; i < 60; ++i) cycle();  // the backlog lasts for 51 rounds, which are 204 ms

  EXPECT_EQ(refused(CommandRefusal::waited), 500U);
  EXPECT_EQ(bridge.commands_refused(), 500U);
  ASSERT_EQ(lcm.replies.size(), 1U);
  EXPECT_NE(lcm.replies[0].find("did not run for 6"), std::string::npos) << lcm.replies[0];
  lcm.arrive(bridge.channels().command, command(6));
  cycle();
  EXPECT_EQ(bridge.commands_taken(), 1U);
}

TEST_F(StoppedDaemon, RefusesARequestFromBeforeTheEndOfALongGapWheneverItArrives) {
  request_t waited = request(1);
  rig.world->advance_to(rig.world->now() + 6s);
  for (int i = 0; i < 500; ++i) cycle();
  lcm.arrive(bridge.channels().request, waited);
  cycle();
  lcm.arrive(bridge.channels().request, request(2));
  cycle();

  ASSERT_EQ(lcm.replies.size(), 2U);
  EXPECT_NE(lcm.replies[0].find("did not run for 6"), std::string::npos) << lcm.replies[0];
  EXPECT_EQ(lcm.replies[1], "");
}

/// A bus on which commands are valid for 4 s.
class LongLived : public StoppedDaemon {
 protected:
  LongLived() : StoppedDaemon{1000} {}
};

TEST_F(LongLived, CommandsFromImagesOfBeforeAGapAreDiscardedWheneverTheyArrive) {
  command_t late = command(15);
  late.time_to_live = 0;
  rig.world->advance_to(rig.world->now() + 300ms);
  for (int i = 0; i < 20; ++i) cycle();  // 80 ms: the transports were empty for long
  lcm.arrive(bridge.channels().command, late);
  cycle();

  EXPECT_EQ(bridge.commands_taken(), 0U);
  EXPECT_EQ(refused(CommandRefusal::waited), 1U);
  lcm.arrive(bridge.channels().command, command(6));
  cycle();
  EXPECT_EQ(bridge.commands_taken(), 1U);
}

TEST_F(LongLived, ACopyOfAnOlderCommandChangesNothing) {
  const command_t first = command(1);
  lcm.arrive(bridge.channels().command, first);
  for (int i = 0; i < 2; ++i) cycle();
  lcm.arrive(bridge.channels().command, command(2));
  cycle();
  lcm.arrive(bridge.channels().command, first);
  cycle();

  EXPECT_EQ(bridge.commands_taken(), 2U);
  EXPECT_EQ(refused(CommandRefusal::overtaken), 1U);
}

TEST_F(LongLived, TheWarningNamesTheTimeToLiveOfTheCommandIfItWasTheShorterOne) {
  lcm.arrive(bridge.channels().command, command(6));
  for (int i = 0; i < 20; ++i) cycle();

  EXPECT_NE(fallback.find("within 20 ms (time_to_live of the command): its fallback is sent"),
            std::string::npos)
      << fallback;
}

/// A bus on which the validity of commands has no limit.
class Unlimited : public StoppedDaemon {
 protected:
  Unlimited() : StoppedDaemon{0} {}
};

TEST_F(Unlimited, TheWarningNamesTheTimeToLiveOfTheCommandIfNoneIsConfigured) {
  lcm.arrive(bridge.channels().command, command(6));
  for (int i = 0; i < 20; ++i) cycle();

  EXPECT_NE(fallback.find("within 20 ms (time_to_live of the command)"), std::string::npos)
      << fallback;
}

TEST_F(StoppedDaemon, RefusesARequestFromMoreThanASecondInTheFuture) {
  request_t future = request(1);
  future.utime += 1'100'000;
  lcm.arrive(bridge.channels().request, future);
  cycle();
  future.id = 2;
  future.utime -= 200'000;
  lcm.arrive(bridge.channels().request, future);
  cycle();
  future.id = 3;
  future.utime = INT64_MAX;
  lcm.arrive(bridge.channels().request, future);
  future.id = 4;
  future.utime = INT64_MIN;
  lcm.arrive(bridge.channels().request, future);
  cycle();

  ASSERT_EQ(lcm.replies.size(), 4U);
  EXPECT_NE(lcm.replies[0].find("more than 1 s ahead"), std::string::npos) << lcm.replies[0];
  EXPECT_EQ(lcm.replies[1], "") << "the clocks of two machines differ a little";
  EXPECT_NE(lcm.replies[2].find("more than 1 s ahead"), std::string::npos) << lcm.replies[2];
  EXPECT_NE(lcm.replies[3].find("more than 10 s before the clock"), std::string::npos)
      << lcm.replies[3];
}

TEST_F(StoppedDaemon, JudgesAgeByTheClockWhereOnlyItsFrontStoodStillForAMoment) {
  lcm.arrive(bridge.channels().command, command(15));
  rig.world->advance_to(rig.world->now() + 30ms);  // no gap, but too long for 5 cycles of 4 ms

  bridge.serve();

  EXPECT_EQ(bridge.commands_taken(), 0U);
  EXPECT_EQ(bridge.commands_refused(), 1U);
}

TEST_F(StoppedDaemon, SendsTheNewestImageFirst) {
  const std::int64_t last = lcm.images.back();
  lcm.images.clear();
  for (int i = 0; i < 50; ++i) rig.master->cycle();
  bridge.serve();

  ASSERT_EQ(lcm.images.size(), 1U);
  EXPECT_EQ(lcm.images[0], last + 50);
}

TEST_F(StoppedDaemon, RefusesRequestsThatWaitedOrAreOldByTheirTime) {
  request_t request{};
  request.schema = message_schema;
  request.service = "emcy_history";
  request.node_id = 1;
  request.id = 1;
  const auto now = [&] { return clocks.now() / std::chrono::microseconds{1}; };
  request.utime = now();
  lcm.arrive(bridge.channels().request, request);
  rig.world->advance_to(rig.world->now() + 2s);
  bridge.serve();
  for (int i = 0; i < 10; ++i) cycle();
  request.id = 2;
  request.utime = now() - 11'000'000;
  lcm.arrive(bridge.channels().request, request);
  cycle();
  request.id = 3;
  request.utime = now();
  lcm.arrive(bridge.channels().request, request);
  cycle();

  ASSERT_EQ(lcm.replies.size(), 3U);
  EXPECT_NE(lcm.replies[0].find("did not run for 2"), std::string::npos) << lcm.replies[0];
  EXPECT_NE(lcm.replies[1].find("more than 10 s before the clock"), std::string::npos)
      << lcm.replies[1];
  EXPECT_EQ(lcm.replies[2], "");
}

TEST_F(StoppedDaemon, AnswersTransfersThatWaitedOrAreOldByTheirTimeAndDoesNothing) {
  transfer_t transfer{};
  transfer.schema = message_schema;
  transfer.session = 7;
  transfer.sender = "tool";
  transfer.action = "upload";
  transfer.node_id = 1;
  transfer.index = 0x1000;
  const auto now = [&] { return clocks.now() / std::chrono::microseconds{1}; };
  transfer.id = 1;
  transfer.utime = now();
  lcm.arrive(bridge.channels().transfer, transfer);
  rig.world->advance_to(rig.world->now() + 2s);
  bridge.serve();
  for (int i = 0; i < 10; ++i) cycle();
  transfer.id = 2;
  transfer.utime = now() - 11'000'000;
  lcm.arrive(bridge.channels().transfer, transfer);
  transfer.action = "end";  // without a request for an answer
  lcm.arrive(bridge.channels().transfer, transfer);
  for (int i = 0; i < 10; ++i) cycle();

  ASSERT_EQ(lcm.transfers.size(), 2U);
  EXPECT_EQ(lcm.transfers[0].id, 1);
  EXPECT_EQ(lcm.transfers[0].stage, "failed");
  EXPECT_NE(lcm.transfers[0].text.find("did not run for 2"), std::string::npos);
  EXPECT_EQ(lcm.transfers[1].id, 2);
  EXPECT_NE(lcm.transfers[1].text.find("more than 10 s before the clock"), std::string::npos);
}

TEST_F(StoppedDaemon, AnswersNoHistoryForAnotherSessionOrSchema) {
  request_t other = request(1);
  other.session = 8;
  lcm.arrive(bridge.channels().request, other);
  other = request(2);
  other.schema = 1;
  lcm.arrive(bridge.channels().request, other);
  other = request(3);
  other.session = 7;
  lcm.arrive(bridge.channels().request, other);
  cycle();

  EXPECT_EQ(lcm.replies, (std::vector<std::string>{"the request is for another session of taktd",
                                                   schema_refusal(1), ""}));
}

TEST_F(StoppedDaemon, BeginsARecordingOnceHoweverOftenItsRequestComes) {
  std::vector<request_t> begun;
  bridge.record_with([&](const request_t& record) -> std::optional<std::string> {
    begun.push_back(record);
    return std::nullopt;
  });
  request_t record = request(5);
  record.service = "record";
  const auto repeat = [&] {
    for (int i = 0; i < 20; ++i) cycle();  // 80 ms: copies of a message are closer to each other
    lcm.arrive(bridge.channels().request, record);
    cycle();
  };
  repeat();
  repeat();
  EXPECT_TRUE(lcm.replies.empty());
  ASSERT_EQ(begun.size(), 1U);
  bridge.answer(begun[0], true, "a.log");
  repeat();

  EXPECT_EQ(begun.size(), 1U);
  EXPECT_EQ(lcm.replies, (std::vector<std::string>{"a.log", "a.log"}));
}

TEST_F(StoppedDaemon, CountsTheGapsAfterWhichLinesOfItsTextGatewayAreOld) {
  EXPECT_EQ(bridge.gaps(), 0U);
  rig.world->advance_to(rig.world->now() + 300ms);
  bridge.serve();
  EXPECT_EQ(bridge.gaps(), 1U);
  EXPECT_EQ(bridge.long_gaps(), 0U);
  EXPECT_GE(bridge.newest_gap(), 300ms);
  rig.world->advance_to(rig.world->now() + 2s);
  bridge.serve();
  for (int i = 0; i < 10; ++i) cycle();
  EXPECT_EQ(bridge.gaps(), 2U);
  EXPECT_EQ(bridge.long_gaps(), 1U);
  EXPECT_GE(bridge.newest_long_gap(), 2s);
}

TEST_F(StoppedDaemon, DiscardsASetPointOfItsTextGatewayIfItStoodStillSinceItLookedForLines) {
  const std::vector<SignalIndex> signals{
      static_cast<SignalIndex>(rig.master->plan().layout.inputs)};
  const std::vector<std::int64_t> values{6};
  EXPECT_TRUE(bridge.command("gateway", signals, values));
  rig.world->advance_to(rig.world->now() + 300ms);

  EXPECT_FALSE(bridge.command("gateway", signals, values));
  EXPECT_EQ(bridge.gaps(), 1U);
  EXPECT_EQ(bridge.commands_taken(), 1U);
  EXPECT_EQ(refused(CommandRefusal::waited), 1U);
}

TEST_F(StoppedDaemon, ReportsTheKeyTheTimeAndTheSenderOfAFallback) {
  lcm.arrive(bridge.channels().command, command(6));
  for (int i = 0; i < 20; ++i) cycle();

  EXPECT_NE(fallback.find("on_timeout: after"), std::string::npos) << fallback;
  EXPECT_NE(fallback.find("20 ms"), std::string::npos) << fallback;
  EXPECT_NE(fallback.find("its last sender was 'app'"), std::string::npos) << fallback;
}

}  // namespace
}  // namespace takt
