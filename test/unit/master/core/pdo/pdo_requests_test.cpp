#include "master/core/pdo/pdo_requests.hpp"

#include <array>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// A plan whose node 1 has a TPDO1 of six bytes and an RPDO1 on request.
BusPlan plan_of(Time poll = {}, std::uint16_t poll_syncs = 0) {
  BusPlan plan = test::axes({.nodes = 2, .tpdo_type = 253});
  plan.pdos.tpdos[0].poll = poll;
  plan.pdos.tpdos[0].poll_syncs = poll_syncs;
  plan.pdos.rpdos[0].on_request = true;
  return plan;
}

class Asker {
 public:
  explicit Asker(BusPlan plan) : plan_{std::move(plan)}, requests{plan_} {}

  std::vector<Frame> at(Time now, std::uint64_t beat = 1, std::size_t room = 100) {
    out_.clear();
    out_.set_limit(room);
    requests.on_time(exchanging, beat, now, out_);
    return {out_.frames().begin(), out_.frames().end()};
  }
  bool ask(std::uint64_t id, RequestKind kind, std::initializer_list<std::uint8_t> data = {},
           std::uint16_t number = 1) {
    Request request{.id = id, .kind = kind, .node = 1, .object = {number, 0}};
    for (const std::uint8_t byte : data) request.data[request.size++] = std::byte{byte};
    return requests.submit(request, 0ms);
  }
  /// Makes a request at 1 ms that stays without an answer; the request times out at 501 ms.
  void ask_in_vain() {
    ask(1, RequestKind::pdo_exchange, {1, 0, 0, 0, 0, 0});
    at(1ms);
    at(501ms);
    const auto timed_out = replies();
    ASSERT_EQ(timed_out.size(), 1U);
    EXPECT_EQ(timed_out[0].fault, SdoFault::timeout);
  }
  void answer(Time when, std::initializer_list<std::uint8_t> bytes) {
    requests.on_frame(0, {.frame = make_frame(CobId::base(0x181), bytes), .when = when});
  }
  std::vector<Reply> replies() {
    std::vector<Reply> all;
    for (Reply reply; requests.take(reply);) all.push_back(reply);
    return all;
  }

 private:
  BusPlan plan_;
  Outbox out_;

 public:
  PdoRequests requests;
  std::array<bool, 128> exchanging{true, true};
};

const Frame remote{.id = CobId::base(0x181), .length = 6, .rtr = true};

TEST(PdoRequests, PollEachTimeWithARemoteRequestOfThePdosLength) {
  Asker asker{plan_of(10ms)};
  std::vector<int> sent;
  for (int ms = 0; ms < 40; ms += 4) {
    const auto frames = asker.at(1ms * ms);
    if (!frames.empty()) sent.push_back(ms);
    if (!frames.empty()) {
      EXPECT_EQ(frames, std::vector{remote});
    }
  }
  EXPECT_EQ(sent, (std::vector{0, 12, 20, 32}));
}

TEST(PdoRequests, PollInEachCycleWhereItsTimeIsThatOfTheCycle) {
  BusPlan plan = plan_of(10ms);
  plan.cycle.period = 10ms;
  Asker asker{std::move(plan)};
  int sent = 0;
  for (int cycle = 0; cycle < 100; ++cycle) {
    const Time jitter = cycle % 2 == 0 ? 300us : -300us;
    sent += !asker.at(10ms * cycle + 1ms + jitter).empty();
  }
  EXPECT_EQ(sent, 100);
}

TEST(PdoRequests, PollEveryNthSync) {
  Asker asker{plan_of({}, 3)};
  std::vector<std::uint64_t> sent;
  for (std::uint64_t beat = 1; beat <= 9; ++beat) {
    if (!asker.at(1ms, beat).empty()) sent.push_back(beat);
    EXPECT_TRUE(asker.at(1ms, beat).empty()) << "once a SYNC";
  }
  EXPECT_EQ(sent, (std::vector<std::uint64_t>{3, 6, 9}));
}

TEST(PdoRequests, DoNotPollANodeThatExchangesNothing) {
  Asker asker{plan_of(10ms)};
  asker.exchanging[0] = false;
  EXPECT_TRUE(asker.at(20ms).empty());
}

TEST(PdoRequests, AnswerAPollOnDemandWithTheBytesOfThePdo) {
  Asker asker{plan_of()};
  ASSERT_TRUE(asker.ask(7, RequestKind::pdo_poll));
  EXPECT_EQ(asker.at(1ms), std::vector{remote});
  EXPECT_TRUE(asker.requests.waiting());
  EXPECT_TRUE(asker.at(2ms).empty());

  asker.answer(3ms, {1, 2, 3, 4, 5, 6});

  const auto replies = asker.replies();
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].id, 7U);
  EXPECT_EQ(replies[0].fault, SdoFault::none);
  EXPECT_EQ(replies[0].size, 6);
  EXPECT_EQ(replies[0].data[5], std::byte{6});
  EXPECT_FALSE(asker.requests.waiting());
}

// P15.13 := 1 of node 3 in the fact sheet, here node 1
TEST(PdoRequests, ExchangeAnRpdoForTheTpdoThatAnswersIt) {
  BusPlan plan = plan_of();
  plan.pdos.rpdos[0].length = 8;
  Asker asker{plan};
  asker.ask(1, RequestKind::pdo_exchange, {0x02, 0x00, 0x0D, 0x0F, 0x01, 0x00, 0x00, 0x00});
  EXPECT_EQ(asker.at(5ms), std::vector{make_frame(CobId::base(0x201), {0x02, 0x00, 0x0D, 0x0F, 0x01,
                                                                       0x00, 0x00, 0x00})});
  asker.answer(4ms, {9, 9, 9, 9, 9, 9, 9, 9});  // sent before the request
  EXPECT_TRUE(asker.replies().empty());
  asker.answer(6ms, {0x01, 0, 0, 0, 0x01, 0, 0, 0});
  const auto replies = asker.replies();
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].size, 8);
  EXPECT_EQ(replies[0].data[4], std::byte{1});
}

TEST(PdoRequests, CountTheRpdosThatTheySend) {
  Asker asker{plan_of()};
  for (int i = 0; i < 3; ++i) {
    asker.ask(1, RequestKind::pdo_exchange, {1, 0, 0, 0, 0, 0});
    asker.at(1ms, 1, 0);
    EXPECT_EQ(asker.requests.sent(0), static_cast<std::uint32_t>(i)) << "no room yet";
    asker.at(2ms);
    asker.answer(3ms, {1, 0, 0, 0, 0, 0});
    ASSERT_EQ(asker.replies().size(), 1U);
  }
  asker.ask(2, RequestKind::pdo_poll);
  ASSERT_EQ(asker.at(4ms), std::vector{remote});
  EXPECT_EQ(asker.requests.sent(0), 3U);
  EXPECT_EQ(asker.requests.sent(1), 0U);
}

TEST(PdoRequests, WaitNoLongerThanTheirTime) {
  Asker asker{plan_of()};
  asker.ask(1, RequestKind::pdo_exchange, {1, 0, 0, 0, 0, 0});
  asker.at(0ms);
  asker.at(499ms);
  EXPECT_TRUE(asker.replies().empty());
  asker.at(500ms);
  const auto replies = asker.replies();
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].fault, SdoFault::timeout);
  asker.answer(501ms, {1, 2, 3, 4, 5, 6});
  EXPECT_TRUE(asker.replies().empty()) << "answered once";
  EXPECT_FALSE(asker.requests.waiting());
}

// The answer of a DRV-28 does not say to which parameter it belongs.
TEST(PdoRequests, NeverTakeALateAnswerForThatOfTheNext) {
  Asker asker{plan_of()};
  asker.ask_in_vain();
  EXPECT_FALSE(asker.requests.idle());
  asker.ask(2, RequestKind::pdo_exchange, {2, 0, 0, 0, 0, 0});
  EXPECT_TRUE(asker.at(510ms).empty()) << "the answer may still come";
  asker.answer(600ms, {1, 1, 1, 1, 1, 1});
  EXPECT_TRUE(asker.replies().empty());

  EXPECT_EQ(asker.at(601ms).size(), 1U) << "it came";
  asker.answer(602ms, {2, 2, 2, 2, 2, 2});

  const auto replies = asker.replies();
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].id, 2U);
  EXPECT_EQ(replies[0].data[0], std::byte{2});
  EXPECT_TRUE(asker.requests.idle());
}

TEST(PdoRequests, WaitForALateAnswerAsLongAsForOneInTime) {
  Asker asker{plan_of()};
  asker.ask_in_vain();
  asker.ask(2, RequestKind::pdo_exchange, {2, 0, 0, 0, 0, 0});
  EXPECT_TRUE(asker.at(1000ms).empty());
  EXPECT_EQ(asker.at(1001ms).size(), 1U);
  asker.answer(1002ms, {2, 2, 2, 2, 2, 2});
  EXPECT_EQ(asker.replies().size(), 1U);
}

TEST(PdoRequests, WaitForALateAnswerNoLessForTheMastersOwnAbsence) {
  Asker asker{plan_of()};
  asker.ask_in_vain();
  asker.ask(2, RequestKind::pdo_exchange, {2, 0, 0, 0, 0, 0});
  asker.requests.extend_deadlines(2s);
  EXPECT_TRUE(asker.at(3000ms).empty());
  EXPECT_EQ(asker.at(3001ms).size(), 1U);
}

TEST(PdoRequests, CountNoTimeOfTheMastersOwnAbsence) {
  Asker asker{plan_of()};
  asker.ask(1, RequestKind::pdo_poll);
  asker.at(0ms);
  asker.requests.extend_deadlines(2s);
  asker.at(2s + 499ms);
  EXPECT_TRUE(asker.replies().empty());
  asker.at(2s + 500ms);
  EXPECT_EQ(asker.replies().size(), 1U);
}

TEST(PdoRequests, ForOnePdoGoOneAfterAnother) {
  Asker asker{plan_of()};
  asker.ask(1, RequestKind::pdo_exchange, {1, 0, 0, 0, 0, 0});
  asker.ask(2, RequestKind::pdo_exchange, {2, 0, 0, 0, 0, 0});
  EXPECT_EQ(asker.at(0ms).size(), 1U);
  EXPECT_TRUE(asker.at(1ms).empty());
  asker.answer(2ms, {1, 0, 0, 0, 0, 0});
  const auto second = asker.at(3ms);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(second[0].data[0], 2);
}

TEST(PdoRequests, AreRefusedForPdosThatCantBeAsked) {
  Asker asker{plan_of()};
  asker.ask(1, RequestKind::pdo_poll, {}, 2);
  Request other{.id = 2, .kind = RequestKind::pdo_exchange, .node = 2, .object = {1, 0}};
  asker.requests.submit(other, 0ms);  // part of the image
  asker.ask(3, RequestKind::pdo_poll);
  asker.exchanging[0] = false;
  EXPECT_TRUE(asker.at(0ms).empty());
  std::vector<SdoFault> faults;
  for (const Reply& reply : asker.replies()) faults.push_back(reply.fault);
  EXPECT_EQ(faults,
            (std::vector{SdoFault::no_such_pdo, SdoFault::no_such_pdo, SdoFault::not_exchanging}));
}

TEST(PdoRequests, AreRefusedWhereTheRpdoHasAnotherLength) {
  Asker asker{plan_of()};  // six bytes
  asker.ask(1, RequestKind::pdo_exchange, {1, 2, 3, 4, 5});
  asker.ask(2, RequestKind::pdo_exchange, {1, 2, 3, 4, 5, 6, 7});
  EXPECT_TRUE(asker.at(0ms).empty());
  const auto replies = asker.replies();
  ASSERT_EQ(replies.size(), 2U);
  for (const Reply& reply : replies) EXPECT_EQ(reply.fault, SdoFault::wrong_length);
}

TEST(PdoRequests, TakeAnyLengthWhereTheMappingIsNotKnown) {
  BusPlan plan = plan_of();
  plan.pdos.rpdos[0].length = 0;
  Asker asker{plan};
  asker.ask(1, RequestKind::pdo_exchange, {1, 2, 3});
  EXPECT_EQ(asker.at(0ms), std::vector{make_frame(CobId::base(0x201), {1, 2, 3})});
}

TEST(PdoRequests, AreAnsweredEvenWhereNothingCanBeSentForLong) {
  Asker asker{plan_of()};
  for (std::uint64_t id = 0; id < PdoRequests::capacity; ++id) {
    EXPECT_TRUE(asker.ask(id, RequestKind::pdo_poll));
  }
  EXPECT_FALSE(asker.ask(99, RequestKind::pdo_poll)) << "full";
  for (Time now = 0ms; now <= 8s; now += 10ms) asker.at(now, 1, 0);
  EXPECT_EQ(asker.replies().size(), PdoRequests::capacity);
}

}  // namespace
}  // namespace takt
