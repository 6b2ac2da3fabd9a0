#include "master/gateway/command/requests.hpp"

#include <chrono>
#include <gtest/gtest.h>
#include <vector>

#include "master/lcm/messages.hpp"
#include "test/unit/master/gateway/a_plan.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

class RequestsTest : public testing::Test {
 protected:
  static request_t upload(std::int64_t id) {
    request_t message{};
    message.schema = 2;
    message.id = id;
    message.sender = "takt-1";
    message.service = "sdo_upload";
    message.node_id = 5;
    message.index = 0x1018;
    message.sub = 1;
    return message;
  }

  BusPlan plan = test::a_plan();
  std::vector<Request> submitted;
  bool room = true;
  Time now = 100s;
  Requests requests{plan, {.session = 42, .observe = false}, [this](const Request& request) {
                      if (room) submitted.push_back(request);
                      return room;
                    }};
};

TEST_F(RequestsTest, EachRequestIsAnsweredExactlyOnce) {
  EXPECT_FALSE(requests.take(upload(7), now));
  ASSERT_EQ(submitted.size(), 1U);
  EXPECT_EQ(submitted[0].object, (ObjectKey{0x1018, 1}));
  Reply reply{.id = submitted[0].id};
  reply.size = 2;
  reply.data[0] = std::byte{0x34};
  reply.data[1] = std::byte{0x12};

  const auto answer = requests.finish(reply, now);

  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->id, 7);
  EXPECT_EQ(answer->sender, "takt-1");
  EXPECT_NE(answer->good, 0);
  EXPECT_EQ(answer->data, (std::vector<std::uint8_t>{0x34, 0x12}));
  EXPECT_FALSE(requests.finish(reply, now));
  EXPECT_EQ(requests.pending(), 0U);
}

TEST_F(RequestsTest, RepeatedRequestIsNotDoneTwice) {
  requests.take(upload(7), now);

  EXPECT_FALSE(requests.take(upload(7), now));
  EXPECT_EQ(submitted.size(), 1U);
}

TEST_F(RequestsTest, ARequestThatTheFrontServesIsBegunOnceAndItsAnswerRepeated) {
  request_t record = upload(7);
  record.service = "record";
  int begun = 0;
  const auto begin = [&](const request_t&) -> std::optional<std::string> {
    ++begun;
    return std::nullopt;
  };
  EXPECT_FALSE(requests.take(record, now, begin));
  EXPECT_FALSE(requests.take(record, now + 1s, begin)) << "the recording is still going on";
  reply_t reply{};
  reply.good = 1;
  reply.text = "a.log";
  requests.finish(record, reply, now + 2s);

  const auto again = requests.take(record, now + 3s, begin);

  ASSERT_TRUE(again);
  EXPECT_EQ(again->good, 1);
  EXPECT_EQ(again->text, "a.log");
  EXPECT_EQ(begun, 1);
  EXPECT_EQ(submitted.size(), 0U);
}

TEST_F(RequestsTest, ARequestThatTheFrontCannotBeginMayBeSentAgainAtOnce) {
  std::optional<std::string> trouble = "the black box is off";
  const auto begin = [&](const request_t&) { return trouble; };

  const auto refused = requests.take(upload(7), now, begin);

  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->good, 0);
  EXPECT_EQ(refused->text, "the black box is off");
  trouble.reset();
  EXPECT_FALSE(requests.take(upload(7), now, begin));
}

TEST_F(RequestsTest, ARequestThatTheFrontServesHasThisSchemaAndThisSession) {
  int begun = 0;
  const auto begin = [&](const request_t&) -> std::optional<std::string> {
    ++begun;
    return std::nullopt;
  };
  request_t request = upload(7);
  request.session = 41;
  const auto other_session = requests.take(request, now, begin);
  request.session = 42;
  request.schema = 1;
  const auto other_schema = requests.take(request, now, begin);

  ASSERT_TRUE(other_session);
  EXPECT_EQ(other_session->text, "the request is for another session of taktd");
  ASSERT_TRUE(other_schema);
  EXPECT_EQ(other_schema->text, schema_refusal(1));
  EXPECT_EQ(begun, 0);
}

TEST_F(RequestsTest, RepeatAfterTheAnswerGetsThatAnswerAgain) {
  requests.take(upload(7), now);
  Reply reply{.id = submitted[0].id};
  reply.size = 1;
  reply.data[0] = std::byte{0x55};
  requests.finish(reply, now);

  const auto again = requests.take(upload(7), now + 9s);

  ASSERT_TRUE(again);
  EXPECT_EQ(again->id, 7);
  EXPECT_NE(again->good, 0);
  EXPECT_EQ(again->data, (std::vector<std::uint8_t>{0x55}));
  EXPECT_EQ(submitted.size(), 1U);
}

TEST_F(RequestsTest, AnotherRequestOfAUsedIdIsRefusedAndTaken12sLater) {
  requests.take(upload(7), now);
  requests.finish({.id = submitted[0].id}, now);
  request_t other = upload(7);
  other.index = 0x1000;

  const auto refused = requests.take(other, now + 5s);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->good, 0);
  EXPECT_NE(refused->text.find("id 7 of this sender was used some seconds ago already"),
            std::string::npos);

  EXPECT_TRUE(requests.take(other, now + 12s));
  EXPECT_FALSE(requests.take(other, now + 12s + 1ms));
  ASSERT_EQ(submitted.size(), 2U);
  EXPECT_EQ(submitted[1].object, (ObjectKey{0x1000, 0x01}));
}

TEST_F(RequestsTest, TheNameOfAnUnknownServiceIsAnsweredWithoutControlCharacters) {
  request_t unknown = upload(7);
  unknown.service = "x\x1b[2J";
  request_t too_long = upload(8);
  too_long.service = "\x1b]0;y\x07\n" + std::string(100, 'z');

  const auto first = requests.take(unknown, now);
  const auto second = requests.take(too_long, now);

  ASSERT_TRUE(first && second);
  EXPECT_TRUE(first->text.starts_with("service 'x?[2J' is not known")) << first->text;
  EXPECT_TRUE(second->text.starts_with("service '?]0;y??zzz")) << second->text;
}

TEST_F(RequestsTest, RefusedOneMayBeSentAgain) {
  room = false;
  EXPECT_TRUE(requests.take(upload(7), now));
  room = true;

  EXPECT_FALSE(requests.take(upload(7), now));
  ASSERT_EQ(submitted.size(), 1U);
  EXPECT_TRUE(requests.finish({.id = submitted[0].id}, now));
}

TEST_F(RequestsTest, TheSameMessageByAnotherWayIsAnEcho) {
  request_t message = upload(7);
  message.utime = 1'000'000;
  EXPECT_FALSE(requests.is_echo(message, now));
  EXPECT_TRUE(requests.is_echo(message, now + 20ms));

  EXPECT_FALSE(requests.is_echo(message, now + 1s)) << "sent again";
  message.utime = 1'000'001;
  EXPECT_FALSE(requests.is_echo(message, now + 1s)) << "another one";
}

TEST_F(RequestsTest, RemembersABoundedNumber) {
  for (std::int64_t id = 1; id <= 1000; ++id) {
    requests.take(upload(id), now);
    requests.finish({.id = submitted.back().id}, now);
  }
  EXPECT_EQ(submitted.size(), 1000U);

  EXPECT_FALSE(requests.take(upload(1), now)) << "forgotten";
  EXPECT_TRUE(requests.take(upload(1000), now));
}

TEST_F(RequestsTest, AbortIsReportedInWords) {
  requests.take(upload(1), now);

  const auto answer = requests.finish(
      {.id = submitted[0].id, .fault = SdoFault::aborted_by_device, .abort_code = 0x0602'0000},
      now);

  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->good, 0);
  EXPECT_EQ(answer->abort_code, 0x0602'0000);
  EXPECT_NE(answer->text.find("0x06020000"), std::string::npos);
}

TEST_F(RequestsTest, ATimeOutNamesWhatTheDeviceDidInstead) {
  using std::chrono_literals::operator""ms;
  EXPECT_EQ(fault_text(SdoFault::timeout, 0), "the device did not answer in time");
  EXPECT_EQ(fault_text(SdoFault::timeout, 0, {.answered = ObjectKey{0x1018, 2}}),
            "the device did not answer in time; it sent an answer for 1018:02 instead");

  requests.take(upload(1), now);
  const auto answer = requests.finish(
      {.id = submitted[0].id, .fault = SdoFault::timeout, .silence = {.late = 900ms}}, now);

  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->text,
            "the device did not answer in time; it answered an earlier request after 900 ms: raise "
            "`sdo_timeout_ms` of the node, or the time-out of this request");
}

TEST_F(RequestsTest, NonsenseIsAnsweredAtOnceAndNeverSubmitted) {
  std::int64_t id = 1;
  const auto refused = [&](auto change) {
    request_t message = upload(++id);
    change(message);
    const auto answer = requests.take(message, now);
    return answer && answer->good == 0 && !answer->text.empty();
  };

  EXPECT_TRUE(refused([](request_t& m) { m.service = "reboot"; }));
  EXPECT_TRUE(refused([](request_t& m) { m.node_id = 128; }));
  EXPECT_TRUE(refused([](request_t& m) { m.node_id = 99; }));
  EXPECT_TRUE(refused([](request_t& m) { m.index = 0x10000; }));
  EXPECT_TRUE(refused([](request_t& m) { m.sub = -1; }));
  EXPECT_TRUE(refused([](request_t& m) { m.session = 41; }));
  EXPECT_TRUE(refused([](request_t& m) { m.schema = 1; }));
  EXPECT_TRUE(refused([](request_t& m) { m.data.resize(1025); }));
  EXPECT_TRUE(refused([](request_t& m) {
    m.service = "nmt";
    m.nmt_command = 3;
  }));
  EXPECT_TRUE(refused([](request_t& m) {
    m.service = "nmt";
    m.nmt_command = 1;
    m.node_id = 99;
  }));
  EXPECT_TRUE(submitted.empty());
}

TEST_F(RequestsTest, NmtGoesToTheMasterItself) {
  request_t message = upload(1);
  message.service = "nmt";
  message.node_id = 127;
  message.nmt_command = 1;

  EXPECT_FALSE(requests.take(message, now));
  ASSERT_EQ(submitted.size(), 1U);
  EXPECT_EQ(submitted[0].node, 127);
}

TEST_F(RequestsTest, NmtStopNamesTheAxesThatWereNotConfirmed) {
  request_t message = upload(1);
  message.service = "nmt";
  message.node_id = 127;
  message.nmt_command = 2;
  EXPECT_FALSE(requests.take(message, now));

  const auto answer = requests.finish({.id = submitted[0].id, .fault = SdoFault::axes_not_stopped},
                                      now, "z was disabled at 75 mm/s");

  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->good, 0);
  EXPECT_EQ(answer->text,
            "the command was executed, but not every axis was seen at standstill and disabled "
            "before the command:\nz was disabled at 75 mm/s");
}

TEST_F(RequestsTest, FullRingIsAnAnswerToo) {
  room = false;

  const auto answer = requests.take(upload(1), now);

  ASSERT_TRUE(answer);
  EXPECT_NE(answer->text.find("again later"), std::string::npos);
}

TEST_F(RequestsTest, NmtGoesToAllNodesOrOne) {
  request_t message = upload(1);
  message.service = "nmt";
  message.node_id = 0;
  message.nmt_command = 129;

  EXPECT_FALSE(requests.take(message, now));
  ASSERT_EQ(submitted.size(), 1U);
  EXPECT_EQ(submitted[0].kind, RequestKind::nmt);
  EXPECT_EQ(submitted[0].node, 0);
  EXPECT_EQ(submitted[0].command, NmtCommand::reset_node);
}

TEST_F(RequestsTest, PdosAreAskedForByNumber) {
  request_t message = upload(8);
  message.service = "pdo_exchange";
  message.index = 1;
  message.size = 2;
  message.data = {0x01, 0x02};
  EXPECT_FALSE(requests.take(message, now));
  ASSERT_EQ(submitted.size(), 1U);
  EXPECT_EQ(submitted[0].kind, RequestKind::pdo_exchange);
  EXPECT_EQ(submitted[0].object.index, 1);
  EXPECT_EQ(submitted[0].size, 2);
  Reply reply{.id = submitted[0].id};
  reply.size = 1;
  reply.data[0] = std::byte{0x55};
  const auto answer = requests.finish(reply, now);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->data, (std::vector<std::uint8_t>{0x55}));

  message.id = 9;
  message.index = 513;
  const auto refused = requests.take(message, now);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->text, "PDO number 513 is not in 1..512");
}

TEST_F(RequestsTest, ThreeHundredSendersOfAMegabyteAreRefusedAndNothingOfThemIsKept) {
  for (std::int64_t id = 1; id <= 300; ++id) {
    request_t message = upload(id);
    message.sender = std::string(1 << 20, 'x');
    EXPECT_FALSE(requests.is_echo(message, now));
    EXPECT_FALSE(requests.is_echo(message, now)) << "it was not remembered";
    const auto answer = requests.take(message, now);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->text, "the sender's name is longer than 64 bytes");
    EXPECT_EQ(answer->sender.size(), 64U);
  }
  EXPECT_TRUE(submitted.empty());
  EXPECT_EQ(requests.pending(), 0U);
}

TEST_F(RequestsTest, AServiceOrAValueOfAMegabyteIsNotKeptEither) {
  request_t service = upload(1);
  service.service = std::string(1 << 20, 's');
  request_t value = upload(2);
  value.service = "sdo_download";
  value.data.resize(1 << 20);
  for (const request_t& message : {service, value}) {
    EXPECT_FALSE(requests.is_echo(message, now));
    EXPECT_FALSE(requests.is_echo(message, now));
    const auto answer = requests.take(message, now);
    ASSERT_TRUE(answer);
    EXPECT_LT(answer->text.size(), 200U);
  }
}

}  // namespace
}  // namespace takt
