// The master stops the axes before an NMT command that ends their PDO exchange.
#include <algorithm>
#include <gtest/gtest.h>
#include <optional>

#include "test/virtual/rig.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::Rig;

constexpr std::uint32_t first_words = 0x201;
constexpr std::uint32_t second_words = 0x202;

/// Two loopback drives; the statusword of each is its last controlword.
class TwoAxes : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(rig.boot()); }
  void order(NmtCommand command, std::uint8_t node) {
    ASSERT_TRUE(
        rig.master->submit({.id = 1, .kind = RequestKind::nmt, .node = node, .command = command}));
  }
  /// Returns the time at which a controlword with these lowest four bits was first sent.
  std::optional<Time> word_at(std::uint32_t id, unsigned low_bits) const {
    for (const sim::WireFrame& wire : rig.recorder.with(id)) {
      if ((wire.frame.data[0] & 0x0FU) == low_bits) {
        return wire.start;
      }
    }
    return std::nullopt;
  }
  std::optional<Time> nmt_at(std::uint8_t command, std::uint8_t node) const {
    for (const sim::WireFrame& wire : rig.recorder.with(0x000)) {
      if (wire.frame.data[0] == command && wire.frame.data[1] == node) return wire.start;
    }
    return std::nullopt;
  }
  /// Commands both axes in each cycle, as an application does.
  void command_for(int cycles, std::int64_t controlword) {
    for (int i = 0; i < cycles; ++i) {
      rig.command_all(controlword, 1);
      rig.run(1);
    }
  }
  /// Returns the fault in the answer to a request; empty before the answer.
  std::optional<SdoFault> answer() {
    Reply reply;
    return rig.master->take(reply) ? std::optional{reply.fault} : std::nullopt;
  }
  /// Expects that the answer takes some time because the axes have to stop first.
  void expect_answer_after_the_stop(NmtCommand command, std::uint8_t node) {
    order(command, node);
    rig.run(5);
    EXPECT_FALSE(answer());
    rig.run(200);
    EXPECT_EQ(answer(), SdoFault::none);
  }
  StopResult stop_in_order() {
    rig.master->request_stop();
    for (int i = 0; i < 5000 && !rig.master->finished(); ++i) rig.cycle();
    EXPECT_TRUE(rig.master->finished());
    return rig.status().stop_result;
  }
  Rig rig{test::axes()};
};

/// The axes are enabled.
class NmtStopOfAxes : public TwoAxes {
 protected:
  void SetUp() override {
    TwoAxes::SetUp();
    rig.command_all(0x000F, 1);
    rig.run(3);
    rig.recorder.frames.clear();
  }
};

TEST_F(NmtStopOfAxes, LeavesWhenEveryAxisWasStoppedAndDisabled) {
  order(NmtCommand::stop, 0);
  rig.run(500);

  const auto stop = nmt_at(0x02, 0);
  ASSERT_TRUE(stop);
  for (const std::uint32_t words : {first_words, second_words}) {
    ASSERT_TRUE(word_at(words, 0x02)) << "quick stop";
    ASSERT_TRUE(word_at(words, 0x00)) << "disable voltage";
    EXPECT_LT(*word_at(words, 0x02) + 50ms, *word_at(words, 0x00)) << "standstill is seen";
    EXPECT_LT(*word_at(words, 0x00), *stop);
  }
  EXPECT_LT(rig.recorder.with(0x080).back().start, *stop + 5ms) << "no SYNC in NMT Stopped";
  EXPECT_EQ(rig.count(EventKind::axis_not_stopped), 0);
}

TEST_F(NmtStopOfAxes, IsAnsweredWhenItWasSent) {
  expect_answer_after_the_stop(NmtCommand::stop, 0);
}

TEST_F(NmtStopOfAxes, LeavesTheAxesOfOtherNodesAlone) {
  for (const NmtCommand command : {NmtCommand::stop, NmtCommand::enter_preoperational}) {
    rig.recorder.frames.clear();
    order(command, 1);
    for (int i = 0; i < 200; ++i) {  // The application of the other axis goes on.
      rig.command(1, 0x000F, 1);
      rig.run(1);
    }

    const auto sent = nmt_at(static_cast<std::uint8_t>(command), 1);
    ASSERT_TRUE(sent);
    ASSERT_TRUE(word_at(first_words, 0x00));
    EXPECT_LT(*word_at(first_words, 0x00), *sent);
    for (const sim::WireFrame& wire : rig.recorder.with(second_words)) {
      ASSERT_EQ(wire.frame.data[0], 0x0F);
    }
    EXPECT_GT(rig.recorder.with(0x080).size(), 190U);

    order(NmtCommand::start, 1);
    rig.run(5);
    rig.command_all(0x000F, 1);
    rig.run(2);
    EXPECT_EQ(rig.recorder.with(first_words).back().frame.data[0], 0x0F) << "it is free again";
  }
}

TEST_F(NmtStopOfAxes, LeavesNoWordOfAnApplicationBehindTheCommand) {
  for (const NmtCommand command : {NmtCommand::stop, NmtCommand::enter_preoperational}) {
    for (const std::uint8_t node : {std::uint8_t{1}, std::uint8_t{0}}) {
      order(command, node);
      command_for(200, 0x000F);

      const auto sent = nmt_at(static_cast<std::uint8_t>(command), node);
      ASSERT_TRUE(sent);
      EXPECT_LT(rig.recorder.with(first_words).back().start, *sent + 5ms);
      EXPECT_EQ(rig.recorder.with(first_words).back().frame.data[0], 0x00);
      order(NmtCommand::start, 0);
      rig.run(10);
      command_for(10, 0x000F);
      ASSERT_EQ(rig.recorder.with(first_words).back().frame.data[0], 0x0F) << "it is free again";
      rig.recorder.frames.clear();
    }
  }
}

TEST_F(NmtStopOfAxes, LeavesAtOnceWhereTheAxesAreDisabled) {
  rig.command_all(0x0000, 1);
  rig.run(3);
  rig.recorder.frames.clear();
  order(NmtCommand::stop, 0);
  rig.run(8);  // Standstill would take 25 cycles to be certain.
  EXPECT_TRUE(nmt_at(0x02, 0));
}

TEST_F(NmtStopOfAxes, DoesNotWaitForADriveThatIsGone) {
  rig.world->power(2_node, false);
  order(NmtCommand::stop, 0);
  rig.run(900);
  EXPECT_TRUE(nmt_at(0x02, 0));
  EXPECT_EQ(rig.count(EventKind::axis_not_stopped), 1);
}

TEST_F(NmtStopOfAxes, GivesWayToTheOrderedStop) {
  order(NmtCommand::stop, 1);
  rig.run(5);
  EXPECT_EQ(stop_in_order(), StopResult::confirmed);
  EXPECT_FALSE(nmt_at(0x02, 1));
}

TEST_F(NmtStopOfAxes, NeedsNoOtherConfirmationInTheOrderedStop) {
  for (const std::uint8_t node : {std::uint8_t{1}, std::uint8_t{2}}) {
    order(NmtCommand::stop, node);
    rig.run(200);
    ASSERT_TRUE(nmt_at(0x02, node));
  }
  EXPECT_EQ(stop_in_order(), StopResult::confirmed);
  EXPECT_EQ(rig.count(EventKind::axis_not_stopped), 0);
}

TEST_F(NmtStopOfAxes, NeedsNoOtherConfirmationWhereAnApplicationGoesOn) {
  order(NmtCommand::stop, 1);
  command_for(200, 0x000F);
  ASSERT_TRUE(nmt_at(0x02, 1));
  EXPECT_EQ(stop_in_order(), StopResult::confirmed);
  EXPECT_EQ(rig.count(EventKind::axis_not_stopped), 0);
}

TEST_F(NmtStopOfAxes, OfAnAxisThatWasNotConfirmedIsNoneInTheOrderedStop) {
  rig.world->power(2_node, false);
  order(NmtCommand::stop, 2);
  rig.run(900);
  ASSERT_EQ(rig.count(EventKind::axis_not_stopped), 1);
  EXPECT_EQ(stop_in_order(), StopResult::unconfirmed);
}

TEST_F(NmtStopOfAxes, OfTheMasterIsAnsweredWhenItsAxesAreStopped) {
  expect_answer_after_the_stop(NmtCommand::stop, 127);
}

TEST_F(NmtStopOfAxes, OfTheMasterEndsItsPdos) {
  order(NmtCommand::stop, 127);
  command_for(200, 0x000F);
  rig.recorder.frames.clear();
  command_for(100, 0x000F);
  EXPECT_TRUE(rig.recorder.with(first_words).empty());
  EXPECT_TRUE(rig.recorder.with(second_words).empty());
  EXPECT_TRUE(rig.recorder.with(0x080).empty());

  order(NmtCommand::start, 127);
  command_for(20, 0x000F);
  ASSERT_FALSE(rig.recorder.with(first_words).empty());
  EXPECT_EQ(rig.recorder.with(first_words).back().frame.data[0], 0x0F);
}

TEST_F(NmtStopOfAxes, SaysWhereAnAxisWasNotConfirmed) {
  rig.world->power(2_node, false);
  for (const std::uint8_t node :
       {std::uint8_t{127}, std::uint8_t{127}, std::uint8_t{2}, std::uint8_t{0}}) {
    order(NmtCommand::stop, node);
    rig.run(900);
    EXPECT_EQ(answer(), SdoFault::axes_not_stopped) << int{node};
  }
  EXPECT_TRUE(nmt_at(0x02, 2)) << "it is sent all the same";
}

TEST_F(NmtStopOfAxes, OfTheMasterLeavesAtOnceWhereTheAxesAreDisabled) {
  rig.command_all(0x0000, 1);
  rig.run(3);
  order(NmtCommand::stop, 127);
  rig.run(8);
  EXPECT_EQ(answer(), SdoFault::none);
}

TEST_F(NmtStopOfAxes, ResetsAreNotHeldUp) {
  order(NmtCommand::reset_node, 1);
  rig.run(2);
  EXPECT_TRUE(nmt_at(0x81, 1));
}

/// No application has enabled the axes.
class OrderedStopOfDisabledAxes : public TwoAxes {
 protected:
  void SetUp() override {
    TwoAxes::SetUp();
    rig.run(10);
  }
};

TEST_F(OrderedStopOfDisabledAxes, IsConfirmedAfterNmtStopOfTheirNode) {
  order(NmtCommand::stop, 1);
  rig.run(100);
  EXPECT_EQ(stop_in_order(), StopResult::confirmed);
  EXPECT_EQ(rig.count(EventKind::axis_not_stopped), 0);
}

TEST_F(OrderedStopOfDisabledAxes, IsConfirmedAfterTheirNodeHasLostItsPower) {
  rig.world->power(2_node, false);
  rig.run(300);
  EXPECT_EQ(stop_in_order(), StopResult::confirmed);
}

TEST_F(OrderedStopOfDisabledAxes, IsNotConfirmedWhereANodeWasCommandedAndIsSilent) {
  rig.world->power(2_node, false);
  rig.command_all(0x000F, 1);
  rig.run(300);
  EXPECT_EQ(stop_in_order(), StopResult::unconfirmed);
  EXPECT_EQ(rig.count(EventKind::axis_not_stopped), 1);
}

/// The first enabling controlword of an application comes in the cycle before the request for NMT
/// stop, in the same cycle, or in the cycles after it.
TEST_F(OrderedStopOfDisabledAxes, AreNotEnabledWhileNmtStopOfTheirNodeIsUnderWay) {
  for (const int cycle : {-1, 0, 1, 2, 3}) {
    command_for(10, 0x0000);
    rig.recorder.frames.clear();
    for (int i = -2; i < 100; ++i) {
      if (i == 0) order(NmtCommand::stop, 1);
      command_for(1, i >= cycle ? 0x000F : 0x0000);
    }
    const auto stop = nmt_at(0x02, 1);
    ASSERT_TRUE(stop);
    auto words = rig.recorder.with(first_words);
    std::erase_if(words, [&](const sim::WireFrame& wire) { return wire.start > *stop; });
    ASSERT_FALSE(words.empty());
    EXPECT_EQ(words.back().frame.data[0], 0x00) << "the word before NMT stop, cycle " << cycle;
    const auto enabling = std::ranges::count_if(
        words, [](const sim::WireFrame& wire) { return wire.frame.data[0] == 0x0F; });
    EXPECT_EQ(enabling, cycle < 0 ? 1 : 0) << "cycle " << cycle;
    order(NmtCommand::start, 1);
    rig.run(10);
  }
}

Request enabling_word() {
  Request request{
      .id = 1, .kind = RequestKind::sdo_download, .node = 2, .object = {0x6040, 0}, .size = 2};
  request.data[0] = std::byte{0x0F};
  return request;
}

TEST_F(OrderedStopOfDisabledAxes, IsNotConfirmedWhereANodeWasEnabledBySdoAndIsSilent) {
  rig.world->power(2_node, false);
  ASSERT_TRUE(rig.master->submit(enabling_word()));
  rig.run(300);
  EXPECT_EQ(stop_in_order(), StopResult::unconfirmed);
}

TEST_F(OrderedStopOfDisabledAxes, IsConfirmedWhereTheyWereDisabledLongAfterAnEnablingWordBySdo) {
  ASSERT_TRUE(rig.master->submit(enabling_word()));
  rig.run(50);
  command_for(200, 0x0000);
  rig.world->power(2_node, false);
  rig.run(300);
  EXPECT_EQ(stop_in_order(), StopResult::confirmed);
  EXPECT_EQ(rig.count(EventKind::axis_not_stopped), 0);
}

/// The drive is enabled by SDO, then by PDO. Between the NMT stop and the ordered stop the drive is
/// seen only briefly, so the ordered stop has to use what the NMT stop has seen.
TEST_F(OrderedStopOfDisabledAxes, IsConfirmedWhereAnNmtStopHasSeenThemDisabled) {
  rig.command_all(0x000F, 1);
  rig.run(5);
  ASSERT_TRUE(rig.master->submit(enabling_word()));
  rig.run(10);
  order(NmtCommand::stop, 2);
  rig.run(200);
  rig.command(0, 0x0000, 1);
  rig.run(10);
  EXPECT_EQ(stop_in_order(), StopResult::confirmed);
  EXPECT_EQ(rig.count(EventKind::axis_not_stopped), 0);
}

}  // namespace
}  // namespace takt
