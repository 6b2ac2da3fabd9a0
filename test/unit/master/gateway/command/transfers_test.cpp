#include "master/gateway/command/transfers.hpp"

#include <array>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "test/unit/master/gateway/a_plan.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

class TransfersTest : public testing::Test {
 protected:
  static transfer_t message(const char* action, std::int64_t id = 7) {
    transfer_t out{};
    out.schema = 2;
    out.id = id;
    out.sender = "takt-1";
    out.action = action;
    out.node_id = 5;
    out.index = 0x1F50;
    out.sub = 1;
    return out;
  }
  void begin(const char* action, std::int64_t total, std::int64_t id = 7) {
    transfer_t out = message(action, id);
    out.total = total;
    transfers.take(out, now);
  }
  void data(std::int64_t offset, std::vector<std::uint8_t> bytes) {
    transfer_t out = message("data");
    out.offset = offset;
    out.size = static_cast<std::int32_t>(bytes.size());
    out.data = std::move(bytes);
    transfers.take(out, now);
  }
  void more(std::int64_t offset, std::int64_t bytes) {
    transfer_t out = message("more");
    out.offset = offset;
    out.total = bytes;
    transfers.take(out, now);
    on_time();
  }
  /// Runs all steps that are due.
  void on_time() { EXPECT_FALSE(transfers.on_time(now, FrontBudget{clock, 1s})); }
  void reply(SdoFault fault = SdoFault::none, std::uint32_t abort_code = 0) {
    Reply answer{.id = submitted.back().id};
    answer.fault = fault;
    answer.abort_code = abort_code;
    EXPECT_TRUE(transfers.finish(answer));
  }
  const transfer_state_t& last() const { return states.back(); }

  BusPlan plan = test::a_plan();
  std::array<SdoTransfer, 2> buffers;
  std::vector<Request> submitted;
  std::vector<transfer_state_t> states;
  bool room = true;
  Time now = 10s;
  FrontClock clock = [this] { return now; };
  Transfers transfers{
      plan,
      {.session = 42, .observe = false},
      buffers,
      {.submit =
           [this](const Request& request) {
             if (room) submitted.push_back(request);
             return room;
           },
       .state = [this](const transfer_state_t& state) { states.push_back(state); }}};
};

TEST_F(TransfersTest, ADownloadGoesOutWhenItsLastPartIsThere) {
  begin("download", 5);
  EXPECT_EQ(last().stage, "filling");
  data(0, {1, 2, 3});
  EXPECT_EQ(last().received, 3);
  EXPECT_TRUE(submitted.empty());

  data(3, {4, 5});

  ASSERT_EQ(submitted.size(), 1U);
  EXPECT_EQ(submitted[0].kind, RequestKind::sdo_download);
  EXPECT_EQ(submitted[0].object, (ObjectKey{0x1F50, 1}));
  EXPECT_EQ(submitted[0].transfer, &buffers[0]);
  EXPECT_EQ(buffers[0].data, (std::vector<std::byte>{std::byte{1}, std::byte{2}, std::byte{3},
                                                     std::byte{4}, std::byte{5}}));
  EXPECT_EQ(last().stage, "running");
  reply();
  EXPECT_EQ(last().stage, "done");
  transfers.take(message("end"), now);
  EXPECT_TRUE(buffers[0].data.empty());
}

TEST_F(TransfersTest, PartsOutOfOrderAreAskedForAgain) {
  begin("download", 5);
  data(3, {4, 5});
  EXPECT_EQ(last().received, 0);
  data(0, {1, 2, 3});
  data(0, {1, 2, 3});  // the same data twice
  EXPECT_EQ(last().received, 3);
  data(3, {4, 5, 6});  // more than was announced
  EXPECT_EQ(last().received, 3);
  EXPECT_TRUE(submitted.empty());
}

TEST_F(TransfersTest, AnUploadIsFetchedInParts) {
  begin("upload", 4096);
  ASSERT_EQ(submitted.size(), 1U);
  EXPECT_EQ(buffers[0].data.size(), 4096U);
  for (std::size_t i = 0; i < 4096; ++i) buffers[0].data[i] = static_cast<std::byte>(i % 251);
  buffers[0].done = 2500;
  reply();
  EXPECT_EQ(last().stage, "done");
  EXPECT_EQ(last().total, 2500);

  states.clear();
  more(0, 100'000);

  ASSERT_EQ(states.size(), 3U);
  EXPECT_EQ(states[0].data.size(), 1024U);
  EXPECT_EQ(states[2].offset, 2048);
  EXPECT_EQ(states[2].data.size(), 452U);
  EXPECT_EQ(states[2].data[0], 2048 % 251);
}

TEST_F(TransfersTest, AnUploadOnItsWayReportsWhatTheDeviceAnnounced) {
  begin("upload", 4096);
  EXPECT_EQ(last().total, 0);
  buffers[0].announced = 2500;
  buffers[0].done = 700;

  transfers.take(message("status"), now);

  EXPECT_EQ(last().total, 2500);
  EXPECT_EQ(last().done, 700);
  reply(SdoFault::cancelled);
  transfers.take(message("end"), now);
  begin("upload", 4096, 8);
  EXPECT_EQ(last().total, 0) << "of another transfer";
}

TEST_F(TransfersTest, AFailureIsReportedInWords) {
  begin("upload", 100);
  reply(SdoFault::aborted_by_device, 0x0601'0001);
  EXPECT_EQ(last().stage, "failed");
  EXPECT_EQ(last().abort_code, 0x0601'0001);
  EXPECT_NE(last().text.find("write-only"), std::string::npos);
}

TEST_F(TransfersTest, CallingOffReachesTheBusThread) {
  begin("upload", 100);
  EXPECT_FALSE(buffers[0].cancel);
  transfers.take(message("abort"), now);
  EXPECT_TRUE(buffers[0].cancel);
  EXPECT_EQ(last().stage, "running") << "until the bus thread has answered";
  reply(SdoFault::cancelled);
  EXPECT_EQ(last().stage, "failed");
  EXPECT_EQ(last().text, "the program that requested the transfer aborted it");
}

TEST_F(TransfersTest, ASilentSenderIsForgottenButNotItsBufferTooEarly) {
  begin("upload", 100);
  now += 11s;
  on_time();
  EXPECT_TRUE(buffers[0].cancel);
  EXPECT_EQ(buffers[0].data.size(), 100U) << "the bus thread may still write to it";
  reply(SdoFault::cancelled);
  on_time();
  EXPECT_TRUE(buffers[0].data.empty());
}

TEST_F(TransfersTest, ALongFileTakesStepsThatABudgetEnds) {
  begin("upload", 1 << 20);
  EXPECT_EQ(last().stage, "running");
  EXPECT_TRUE(submitted.empty());
  EXPECT_EQ(buffers[0].data.size(), 1U << 16) << "the message itself made one step";

  int rounds = 0;
  while (transfers.on_time(now, FrontBudget{clock, 0s}) && rounds < 100) ++rounds;

  EXPECT_EQ(rounds, 15);
  ASSERT_EQ(submitted.size(), 1U);
  EXPECT_EQ(buffers[0].data.size(), 1U << 20);
}

TEST_F(TransfersTest, PartsThatAreAskedForGoOutOneByOneWhereTheBudgetIsShort) {
  begin("upload", 4096);
  buffers[0].done = 4096;
  reply();
  states.clear();
  transfer_t ask = message("more");
  ask.total = 4096;
  transfers.take(ask, now);
  EXPECT_TRUE(states.empty());

  for (std::size_t sent = 1; sent <= 4; ++sent) {
    EXPECT_TRUE(transfers.on_time(now, FrontBudget{clock, 0s}));
    ASSERT_EQ(states.size(), sent);
    EXPECT_EQ(last().offset, static_cast<std::int64_t>(1024 * (sent - 1)));
  }
  EXPECT_FALSE(transfers.on_time(now, FrontBudget{clock, 0s}));
  EXPECT_EQ(states.size(), 4U);
}

TEST_F(TransfersTest, ThereAreAsManyAsBuffers) {
  begin("upload", 100, 1);
  begin("upload", 100, 2);
  begin("upload", 100, 3);
  EXPECT_EQ(last().stage, "failed");
  EXPECT_EQ(last().id, 3);
  EXPECT_EQ(submitted.size(), 2U);
}

TEST_F(TransfersTest, WaitsForRoomInTheRing) {
  room = false;
  begin("upload", 100);
  EXPECT_EQ(last().stage, "running");
  room = true;
  on_time();
  EXPECT_EQ(submitted.size(), 1U);
}

TEST_F(TransfersTest, ReportsProgressTwiceASecond) {
  begin("upload", 100);
  states.clear();
  for (int i = 0; i < 20; ++i) {
    now += 100ms;
    buffers[0].done = static_cast<std::uint32_t>(i);
    on_time();
  }
  EXPECT_EQ(states.size(), 4U);
  EXPECT_EQ(last().done, 19);
}

TEST_F(TransfersTest, RefusesWhatIsNotPossible) {
  transfer_t wrong = message("download");
  wrong.total = (16 << 20) + 1;
  transfers.take(wrong, now);
  EXPECT_EQ(last().text, "a file has at most 16777216 bytes");
  wrong.total = -1;
  transfers.take(wrong, now);
  EXPECT_EQ(last().stage, "failed");
  wrong = message("download");
  wrong.node_id = 99;
  transfers.take(wrong, now);
  EXPECT_EQ(last().text, "node 99 is not in the network file of bus 'lift'");
  transfers.take(message("data"), now);
  EXPECT_EQ(last().stage, "failed");
  const auto answers = states.size();
  transfers.take(message("end"), now);
  EXPECT_EQ(states.size(), answers);
}

TEST_F(TransfersTest, RepliesToOthersAreLeftAlone) { EXPECT_FALSE(transfers.finish({.id = 1})); }

}  // namespace
}  // namespace takt
