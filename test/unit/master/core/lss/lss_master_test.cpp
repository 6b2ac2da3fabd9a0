#include "master/core/lss/lss_master.hpp"

#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "master/core/lss/lss_runner.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using Bytes = std::array<std::uint8_t, 8>;

Frame answer(Bytes bytes) { return {.id = CobId::base(0x7E4), .length = 8, .data = bytes}; }

/// One service of an LSS master in virtual time; `slave` returns the answers to a request.
struct Talk {
  std::function<std::vector<Bytes>(const Bytes&)> slave = [](const Bytes&) {
    return std::vector<Bytes>{};
  };
  Time latency = 2ms;
  Time timeout{};
  Time now = 5s;
  std::vector<Bytes> sent;
  std::vector<Time> sent_at;

  LssResult run(const LssCommand& command) {
    LssMaster master;
    master.begin(command, timeout, now);
    drive(master, [&] { return !(result = master.take_result()); });
    return *result;
  }
  void run(LssRunner& runner, std::span<const LssCommand> commands) {
    runner.begin(commands, timeout);
    drive(runner, [&] { return runner.running(); });
  }

 private:
  template <class M>
  void drive(M& master, const std::function<bool()>& goes_on) {
    std::vector<std::pair<Time, Frame>> coming;
    for (int steps = 0; goes_on() && steps < 100'000; ++steps) {
      Outbox out;
      master.on_time(now, out);
      for (const Frame& frame : out.frames()) {
        EXPECT_EQ(frame.id, CobId::base(0x7E5));
        EXPECT_EQ(frame.length, 8);
        sent.push_back(frame.data);
        sent_at.push_back(now);
        for (const Bytes& bytes : slave(frame.data)) {
          coming.emplace_back(now + latency, answer(bytes));
        }
      }
      if (!goes_on_after(master)) continue;
      Time next = std::max(master.deadline(), now);
      if (!coming.empty()) next = std::min(next, coming.front().first);
      if (next == now && out.empty()) next = now + 100us;
      now = next;
      if (!coming.empty() && coming.front().first <= now) {
        master.on_frame(coming.front().second, now, out);
        coming.erase(coming.begin());
      }
    }
  }
  template <class M>
  static bool goes_on_after(const M& master) {
    return master.deadline() != at_once;
  }

  std::optional<LssResult> result;
};

// The bytes follow the services of CiA 305 for a slave with vendor-ID 0x15A, product code 2,
// revision 0x00010003 and serial number 0xA5.

TEST(LssAnswer, MayLeaveOutTheBytesThatSayNothing) {
  const auto decoded = [](std::initializer_list<std::uint8_t> bytes) {
    return lss::decode_answer(make_frame(CobId::base(0x7E4), bytes));
  };
  EXPECT_TRUE(decoded({0x44}));
  EXPECT_TRUE(decoded({0x4F}));
  EXPECT_TRUE(decoded({0x50}));
  EXPECT_EQ(decoded({0x11, 0x01})->error, 1);
  EXPECT_EQ(decoded({0x5E, 0x05})->error, 5);
  EXPECT_EQ(decoded({0x5A, 0x5A, 0x01, 0x00, 0x00})->number, 0x15AU);
  EXPECT_FALSE(decoded({}));
  EXPECT_FALSE(decoded({0x11}));
  EXPECT_FALSE(decoded({0x5D, 0x11, 0x00, 0x00}));
}

TEST(LssMaster, SwitchesAllWithoutWaitingForAnAnswer) {
  Talk talk;
  const Time before = talk.now;

  EXPECT_EQ(talk.run({.op = LssOp::switch_global, .a = 1}).outcome, LssOutcome::done);
  EXPECT_EQ(talk.run({.op = LssOp::switch_global, .a = 0}).outcome, LssOutcome::done);

  EXPECT_EQ(talk.sent, (std::vector<Bytes>{{4, 1, 0, 0, 0, 0, 0, 0}, {4, 0, 0, 0, 0, 0, 0, 0}}));
  EXPECT_LE(talk.now - before, 5ms);
}

TEST(LssMaster, SelectsOneDeviceWithFourFrames) {
  Talk talk;
  talk.slave = [](const Bytes& frame) {
    return frame[0] == 0x43 ? std::vector<Bytes>{{0x44}} : std::vector<Bytes>{};
  };

  const auto result =
      talk.run({.op = LssOp::switch_selective, .numbers = {0x15A, 2, 0x0001'0003, 0xA5}});

  EXPECT_EQ(result.outcome, LssOutcome::done);
  EXPECT_EQ(talk.sent, (std::vector<Bytes>{{0x40, 0x5A, 0x01, 0, 0, 0, 0, 0},
                                           {0x41, 0x02, 0, 0, 0, 0, 0, 0},
                                           {0x42, 0x03, 0x00, 0x01, 0, 0, 0, 0},
                                           {0x43, 0xA5, 0, 0, 0, 0, 0, 0}}));
  for (std::size_t i = 1; i < 4; ++i) EXPECT_GE(talk.sent_at[i] - talk.sent_at[i - 1], 1ms);
}

TEST(LssMaster, SaysThatNobodyAnsweredASelection) {
  Talk talk;
  const Time before = talk.now;
  const auto result = talk.run({.op = LssOp::switch_selective, .numbers = {1, 2, 3, 4}});
  EXPECT_EQ(result.outcome, LssOutcome::silent);
  EXPECT_LE(talk.now - before, 1100ms);
  EXPECT_EQ(lss_failure_text(result),
            "switch one device to configuration state: no answer; is there a device in "
            "configuration state, with LSS, on this bus?");
}

TEST(LssMaster, ConfiguresANodeIdAndReportsTheRefusal) {
  Talk talk;
  talk.slave = [](const Bytes& frame) {
    const std::uint8_t error = frame[1] == 5 ? 0 : 1;
    return std::vector<Bytes>{{0x11, error}};
  };

  EXPECT_EQ(talk.run({.op = LssOp::configure_node_id, .a = 5}).outcome, LssOutcome::done);
  const auto refused = talk.run({.op = LssOp::configure_node_id, .a = 200});

  EXPECT_EQ(refused.outcome, LssOutcome::refused);
  EXPECT_EQ(refused.error, 1);
  EXPECT_EQ(lss_failure_text(refused),
            "configure node id: the device reports that this node id is out of range (error 1)");
  EXPECT_EQ(talk.sent,
            (std::vector<Bytes>{{0x11, 5, 0, 0, 0, 0, 0, 0}, {0x11, 0xC8, 0, 0, 0, 0, 0, 0}}));
}

TEST(LssMaster, ConfiguresAndActivatesBitTiming) {
  Talk talk;
  talk.slave = [](const Bytes& frame) {
    if (frame[0] != 0x13) return std::vector<Bytes>{};
    const std::uint8_t error = frame[2] == 5 ? 1 : 0;
    return std::vector<Bytes>{{0x13, error}};
  };

  EXPECT_EQ(talk.run({.op = LssOp::configure_bit_timing, .a = 0, .b = 3}).outcome,
            LssOutcome::done);
  const auto refused = talk.run({.op = LssOp::configure_bit_timing, .a = 0, .b = 5});
  EXPECT_EQ(talk.run({.op = LssOp::activate_bit_timing, .numbers = {1000}}).outcome,
            LssOutcome::done);

  EXPECT_EQ(lss_failure_text(refused),
            "configure bit timing: the device does not support this bit rate (error 1)");
  EXPECT_EQ(talk.sent, (std::vector<Bytes>{{0x13, 0, 3}, {0x13, 0, 5}, {0x15, 0xE8, 0x03}}));
}

TEST(LssMaster, ReportsWhyStoringFailed) {
  Talk talk;
  Bytes says{0x17, 2};
  talk.slave = [&says](const Bytes&) { return std::vector<Bytes>{says}; };

  const auto no_access = talk.run({.op = LssOp::store});
  says = {0x17, 255, 9};
  const auto own_code = talk.run({.op = LssOp::store});
  says = {0x17, 0};
  const auto good = talk.run({.op = LssOp::store});

  EXPECT_EQ(lss_failure_text(no_access),
            "store configuration: the device could not access its storage medium (error 2)");
  EXPECT_EQ(lss_failure_text(own_code),
            "store configuration: the device gave the manufacturer-specific error code 9");
  EXPECT_EQ(good.outcome, LssOutcome::done);
  EXPECT_EQ(talk.sent.front(), (Bytes{0x17}));
}

TEST(LssMaster, WaitsFiveSecondsForAStoringDevice) {
  Talk talk;
  talk.latency = 4900ms;
  talk.slave = [](const Bytes&) { return std::vector<Bytes>{{0x17, 0}}; };
  EXPECT_EQ(talk.run({.op = LssOp::store}).outcome, LssOutcome::done);
  talk.latency = 5100ms;
  EXPECT_EQ(talk.run({.op = LssOp::store}).outcome, LssOutcome::silent);
}

TEST(LssMaster, InquiresEachPartOfTheIdentity) {
  Talk talk;
  talk.slave = [](const Bytes& frame) -> std::vector<Bytes> {
    switch (frame[0]) {
      case 0x5A:
        return {{0x5A, 0x5A, 0x01, 0, 0}};
      case 0x5C:
        return {{0x5C, 0x03, 0x00, 0x01, 0x00}};
      default:
        return {{0x5E, 0x05, 0xFF, 0xFF, 0xFF}};  // the bytes behind the node-ID are reserved
    }
  };
  EXPECT_EQ(talk.run({.op = LssOp::inquire_vendor}).numbers[0], 0x15AU);
  EXPECT_EQ(talk.run({.op = LssOp::inquire_revision}).numbers[0], 0x0001'0003U);
  EXPECT_EQ(talk.run({.op = LssOp::inquire_node_id}).numbers[0], 5U);
  EXPECT_EQ(talk.sent, (std::vector<Bytes>{{0x5A}, {0x5C}, {0x5E}}));
}

TEST(LssMaster, TakesOnlyTheAnswerOfItsService) {
  Talk talk;
  talk.slave = [](const Bytes&) { return std::vector<Bytes>{{0x44}, {0x5A, 1}, {0x11, 0}}; };
  const auto result = talk.run({.op = LssOp::configure_node_id, .a = 5});
  EXPECT_EQ(result.outcome, LssOutcome::done);

  talk.slave = [](const Bytes&) { return std::vector<Bytes>{{0x4F}}; };
  EXPECT_EQ(talk.run({.op = LssOp::configure_node_id, .a = 5}).outcome, LssOutcome::silent);
}

TEST(LssMaster, LetsTheWorstOfSeveralAnswersCount) {
  Talk talk;
  talk.slave = [](const Bytes&) { return std::vector<Bytes>{{0x13, 0}, {0x13, 1}, {0x13, 0}}; };
  const auto result =
      talk.run({.op = LssOp::configure_bit_timing, .a = 0, .b = 3, .several = true});
  EXPECT_EQ(result.outcome, LssOutcome::refused);
  EXPECT_EQ(result.error, 1);
}

TEST(LssMaster, IdentifiesByRangesWithSixFrames) {
  Talk talk;
  talk.slave = [](const Bytes& frame) {
    return frame[0] == 0x4B ? std::vector<Bytes>{{0x4F}, {0x4F}} : std::vector<Bytes>{};
  };

  const auto found = talk.run(
      {.op = LssOp::identify, .numbers = {0x15A, 2, 0x0001'0000, 0x0001'FFFF, 0, 0xFFFF'FFFF}});
  talk.slave = [](const Bytes&) { return std::vector<Bytes>{}; };
  const auto missed = talk.run({.op = LssOp::identify, .numbers = {0x15B, 2}});

  EXPECT_EQ(found.outcome, LssOutcome::done);
  EXPECT_EQ(missed.outcome, LssOutcome::nobody);
  talk.sent.resize(6);
  EXPECT_EQ(talk.sent, (std::vector<Bytes>{{0x46, 0x5A, 0x01},
                                           {0x47, 0x02},
                                           {0x48, 0x00, 0x00, 0x01, 0x00},
                                           {0x49, 0xFF, 0xFF, 0x01, 0x00},
                                           {0x4A},
                                           {0x4B, 0xFF, 0xFF, 0xFF, 0xFF}}));
}

TEST(LssMaster, AsksWhetherSomebodyIsWithoutNodeId) {
  Talk talk;
  talk.slave = [](const Bytes& frame) {
    return frame[0] == 0x4C ? std::vector<Bytes>{{0x50}} : std::vector<Bytes>{};
  };
  EXPECT_EQ(talk.run({.op = LssOp::identify_unconfigured}).outcome, LssOutcome::done);
  EXPECT_EQ(talk.sent, (std::vector<Bytes>{{0x4C}}));
  talk.slave = [](const Bytes&) { return std::vector<Bytes>{}; };
  EXPECT_EQ(talk.run({.op = LssOp::identify_unconfigured}).outcome, LssOutcome::nobody);
}

TEST(LssRunner, SendsAllToWaitingWhenAServiceFails) {
  Talk talk;
  talk.slave = [](const Bytes& frame) {
    return frame[0] == 0x11 ? std::vector<Bytes>{{0x11, 1}} : std::vector<Bytes>{};
  };
  const std::array<LssCommand, 3> commands{LssCommand{.op = LssOp::switch_global, .a = 1},
                                           LssCommand{.op = LssOp::configure_node_id, .a = 128},
                                           LssCommand{.op = LssOp::store}};
  LssRunner runner;

  talk.run(runner, commands);

  EXPECT_FALSE(runner.done());
  ASSERT_EQ(runner.results().size(), 2U);
  EXPECT_EQ(runner.results()[1].outcome, LssOutcome::refused);
  EXPECT_EQ(talk.sent, (std::vector<Bytes>{{4, 1}, {0x11, 0x80}, {4, 0}}));
}

TEST(LssRunner, SendsAllToWaitingWhenTheLastAnswerOfAScanIsLost) {
  Talk talk;
  talk.slave = [](const Bytes& frame) {
    const bool last = frame[6] == 3 && frame[7] == 0;
    return frame[0] == 0x51 && !last ? std::vector<Bytes>{{0x4F}} : std::vector<Bytes>{};
  };
  const std::array<LssCommand, 2> commands{
      LssCommand{.op = LssOp::fast_scan,
                 .numbers = {0x15A, 2, 0x0001'0003, 0xA5, ~0U, ~0U, ~0U, ~0U}},
      LssCommand{.op = LssOp::configure_node_id, .a = 5}};
  LssRunner runner;

  talk.run(runner, commands);

  ASSERT_EQ(runner.results().size(), 1U);
  EXPECT_EQ(runner.results()[0].outcome, LssOutcome::nobody);
  EXPECT_EQ(talk.sent.back(), (Bytes{4, 0}));
}

TEST(LssRunner, SendsNothingAfterAScanThatFoundNobody) {
  Talk talk;
  talk.slave = [](const Bytes& frame) {
    return frame[5] == 0x80 ? std::vector<Bytes>{{0x4F}} : std::vector<Bytes>{};
  };
  const std::array<LssCommand, 1> commands{LssCommand{
      .op = LssOp::fast_scan, .numbers = {0x15A, 2, 0x0001'0003, 0xA5, ~0U, ~0U, ~0U, ~0U}}};
  LssRunner runner;

  talk.run(runner, commands);

  EXPECT_EQ(runner.results()[0].outcome, LssOutcome::nobody);
  EXPECT_EQ(talk.sent.back()[0], 0x51);
}

TEST(LssRunner, LeavesTheStateAloneThatItDidNotChange) {
  Talk talk;
  LssRunner runner;
  const std::array<LssCommand, 1> commands{LssCommand{.op = LssOp::store}};

  talk.run(runner, commands);

  EXPECT_FALSE(runner.done());
  EXPECT_EQ(talk.sent, (std::vector<Bytes>{{0x17}}));
}

TEST(LssCommand, TravelsInThirtySixBytes) {
  const LssCommand command{.op = LssOp::identify, .numbers = {0x15A, 2, 3, 4, 5, 6, 7, 8}};
  std::array<std::byte, lss_command_bytes> bytes{};
  pack(command, bytes);
  EXPECT_EQ(bytes[0], std::byte{0x46});
  EXPECT_EQ(bytes[4], std::byte{0x5A});
  EXPECT_EQ(bytes[5], std::byte{0x01});
  EXPECT_EQ(bytes[32], std::byte{8});
  const auto back = unpack_lss_command(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->numbers, command.numbers);

  bytes[0] = std::byte{0x99};
  EXPECT_FALSE(unpack_lss_command(bytes));
  bytes[0] = std::byte{0x80};  // a scan from 9 to 4
  bytes[12] = std::byte{9};
  EXPECT_FALSE(unpack_lss_command(bytes));
}

}  // namespace
}  // namespace takt
