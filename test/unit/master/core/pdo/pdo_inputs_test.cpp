#include "master/core/pdo/pdo_inputs.hpp"

#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "test/unit/master/core/pdo/small_plan.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// The inputs of a plan and a bus with a SYNC every 2 ms.
class Inputs {
 public:
  explicit Inputs(BusPlan plan, Reception reception = Reception::full)
      : plan_{std::move(plan)}, image{plan_.layout.signals.size()}, pdos{plan_, image, events} {
    for (std::size_t i = 0; i < plan_.nodes.size(); ++i) pdos.set_reception(i, reception);
  }

  void beat() {
    ++cycle_;
    now_ = cycle_ * Time{2ms};
    pdos.begin(static_cast<std::uint64_t>(cycle_), now_);
  }
  void frame(std::uint32_t id, std::initializer_list<std::uint8_t> bytes, Time after = 300us) {
    taken = pdos.receive({.frame = make_frame(CobId::base(id), bytes), .when = now_ + after});
  }
  std::uint32_t close() { return pdos.close(now_ + Time{1200us}); }
  /// Runs a cycle in which these nodes answer.
  std::uint32_t beat_with(std::initializer_list<unsigned> nodes) {
    beat();
    for (const unsigned node : nodes) frame(0x180 + node, {0x37, 0x02, 0x01, 0, 0, 0});
    return close();
  }
  std::vector<Event> reported() {
    std::vector<Event> all;
    for (Event event; events.pop(event);) all.push_back(event);
    return all;
  }

 private:
  BusPlan plan_;
  std::int64_t cycle_ = 0;
  Time now_{};

 public:
  EventQueue events;
  WorkingImage image;
  PdoInputs pdos;
  bool taken = false;
};

TEST(PdoInputs, PutsStatuswordAndNegativePositionIntoTheImage) {
  Inputs in{test::axes()};

  in.beat();
  in.frame(0x182, {0x37, 0x02, 0xFE, 0xFF, 0xFF, 0xFF});  // node 5's example of the fact sheet

  EXPECT_EQ(in.image.values[1], 0x0237);
  EXPECT_EQ(in.image.values[3], -2);
  EXPECT_EQ(in.image.values[0], 0);
}

TEST(PdoInputs, AreStaleUntilTheFirstFrame) {
  Inputs in{test::axes()};
  EXPECT_TRUE(in.image.is_stale(0));
  EXPECT_TRUE(in.image.is_stale(2));

  in.beat_with({1});

  EXPECT_FALSE(in.image.is_stale(0));
  EXPECT_FALSE(in.image.is_stale(2));
  EXPECT_TRUE(in.image.is_stale(1));
}

TEST(PdoInputs, IgnoreForeignIdentifiers) {
  Inputs in{test::axes()};
  in.beat();
  in.frame(0x701, {0x05});
  EXPECT_FALSE(in.taken);
  EXPECT_FALSE(in.pdos.receive({.frame = make_frame(CobId::extended(0x181), {1, 2, 3, 4, 5, 6})}));
}

TEST(PdoInputs, TakeExtendedIdentifiers) {
  BusPlan plan = test::axes({.nodes = 1});
  plan.pdos.route[0x181] = PdoTable::no_row;
  plan.pdos.tpdos[0].cob_id = CobId::extended(0x12345);
  Inputs in{plan};
  in.beat();
  EXPECT_TRUE(
      in.pdos.receive({.frame = make_frame(CobId::extended(0x12345), {0x21, 0, 0, 0, 0, 0})}));
  EXPECT_EQ(in.image.values[0], 0x21);
}

TEST(PdoInputs, IgnoreAShortFrameWholeAndReportItOnce) {
  Inputs in{test::axes({.nodes = 1})};
  in.beat_with({1});

  in.beat();
  in.frame(0x181, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF});
  in.frame(0x181, {0xFF});

  EXPECT_EQ(in.image.values[0], 0x0237);
  EXPECT_EQ(in.pdos.status(0).length_errors, 2U);
  const auto events = in.reported();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, EventKind::pdo_length);
  EXPECT_EQ(events[0].node, 1);
  EXPECT_EQ(events[0].value, 1);
  EXPECT_EQ(events[0].detail, 5U);
}

TEST(PdoInputs, UseTheFirstBytesOfALongFrame) {
  Inputs in{test::axes({.nodes = 1})};
  in.beat();
  in.frame(0x181, {0x40, 0x02, 0x07, 0, 0, 0, 0xAA, 0xBB});
  EXPECT_EQ(in.image.values[0], 0x0240);
  EXPECT_EQ(in.image.values[1], 7);
  EXPECT_EQ(in.pdos.status(0).length_errors, 1U);
  EXPECT_EQ(in.close(), 0U);
}

TEST(PdoInputs, IgnoreRemoteFrames) {
  Inputs in{test::axes({.nodes = 1})};
  in.beat();
  Frame rtr = make_frame(CobId::base(0x181), {9, 9, 9, 9, 9, 9});
  rtr.rtr = true;
  EXPECT_TRUE(in.pdos.receive({.frame = rtr}));
  EXPECT_EQ(in.pdos.status(0).received, 0U);
}

TEST(PdoInputs, IgnoreNodesWhoseMappingIsNotVerified) {
  Inputs in{test::axes({.nodes = 1}), Reception::off};
  in.beat_with({1});
  EXPECT_TRUE(in.taken);
  EXPECT_EQ(in.image.values[0], 0);
  EXPECT_TRUE(in.image.is_stale(0));
}

TEST(PdoInputs, AreCompleteWhenTheLastExpectedHasCome) {
  Inputs in{test::axes()};
  in.beat_with({1, 2});

  in.beat();
  EXPECT_EQ(in.pdos.expected(), 2U);
  in.frame(0x182, {0, 0, 0, 0, 0, 0});
  in.frame(0x182, {0, 0, 0, 0, 0, 0});
  EXPECT_FALSE(in.pdos.complete());
  in.frame(0x181, {0, 0, 0, 0, 0, 0}, 410us);
  EXPECT_TRUE(in.pdos.complete());
  EXPECT_EQ(in.pdos.last_arrival(), 4ms + 410us);
}

TEST(PdoInputs, ReportWhenAPdoBeginsToBeMissingAndWhenItIsBack) {
  Inputs in{test::axes()};
  in.beat_with({1, 2});
  EXPECT_EQ(in.beat_with({1}), 1U);
  EXPECT_EQ(in.beat_with({1}), 1U);
  EXPECT_TRUE(in.image.is_stale(1));
  EXPECT_TRUE(in.image.is_stale(3));
  EXPECT_EQ(in.pdos.status(1).missing, 2U);
  EXPECT_EQ(in.pdos.status(1).age, 2U);

  EXPECT_EQ(in.beat_with({1, 2}), 0U);

  const auto events = in.reported();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, EventKind::pdo_missing);
  EXPECT_EQ(events[0].node, 2);
  EXPECT_EQ(events[0].cycle, 2U);
  EXPECT_EQ(events[1].kind, EventKind::pdo_back);
  EXPECT_FALSE(in.image.is_stale(1));
}

TEST(PdoInputs, NoLongerWaitForANodeThatStaysAway) {
  Inputs in{test::axes()};
  in.beat_with({1, 2});
  for (int i = 0; i < 3; ++i) {
    in.beat();
    EXPECT_EQ(in.pdos.expected(), 2U);
    in.frame(0x181, {0, 0, 0, 0, 0, 0});
    in.close();
  }
  in.beat();
  EXPECT_EQ(in.pdos.expected(), 1U);
  in.frame(0x181, {0, 0, 0, 0, 0, 0});
  EXPECT_TRUE(in.pdos.complete());
  EXPECT_EQ(in.close(), 1U);  // the PDO still counts as missing
}

TEST(PdoInputs, FrameFromBeforeThisSyncDoesNotCompleteTheCycle) {
  Inputs in{test::axes({.nodes = 1})};
  in.beat_with({1});
  in.beat();
  EXPECT_EQ(in.close(), 1U);

  in.beat();
  in.frame(0x181, {0x11, 0, 0, 0, 0, 0}, -500us);  // late answer to the previous SYNC
  EXPECT_EQ(in.image.values[0], 0x11);
  EXPECT_FALSE(in.pdos.complete());
  in.frame(0x181, {0x12, 0, 0, 0, 0, 0});
  EXPECT_TRUE(in.pdos.complete());
  EXPECT_EQ(in.close(), 0U);
}

TEST(PdoInputs, LearnThePhaseOfEveryRateFromTheFirstFrame) {
  for (unsigned n = 1; n <= 240; ++n) {
    const unsigned phase = n / 3 + 1;
    Inputs in{test::axes({.nodes = 1, .tpdo_type = static_cast<std::uint8_t>(n)})};
    for (unsigned beat = 1; beat <= 4 * n; ++beat) {
      in.beat();
      const bool sends = beat >= phase && (beat - phase) % n == 0;
      EXPECT_EQ(in.pdos.expected(), sends && beat > phase ? 1U : 0U) << n << " at " << beat;
      if (sends) in.frame(0x181, {0, 0, 0, 0, 0, 0});
      EXPECT_EQ(in.close(), 0U) << n << " at " << beat;
    }
    EXPECT_TRUE(in.reported().empty()) << n;
  }
}

TEST(PdoInputs, MissASilentPdoOfRateNAfterTwoRounds) {
  Inputs in{test::axes({.nodes = 1, .tpdo_type = 5})};
  for (int beat = 1; beat < 10; ++beat) EXPECT_EQ(in.beat_with({}), 0U);
  EXPECT_EQ(in.beat_with({}), 1U);
  EXPECT_EQ(in.reported().size(), 1U);
}

TEST(PdoInputs, WaitForTheSyncStartValueAsLongAsTheCounterTakes) {
  BusPlan plan = test::axes({.nodes = 1, .tpdo_type = 1});
  plan.cycle.sync_overflow = 10;
  plan.pdos.tpdos[0].sync_start = 10;
  Inputs in{std::move(plan)};
  for (int beat = 1; beat < 12; ++beat) EXPECT_EQ(in.beat_with({}), 0U) << beat;
  EXPECT_EQ(in.beat_with({}), 1U);
}

TEST(PdoInputs, KeepThePhaseOfRateNThroughALoss) {
  Inputs in{test::axes({.nodes = 1, .tpdo_type = 4})};
  in.beat_with({1});
  for (int beat = 2; beat <= 4; ++beat) in.beat_with({});
  EXPECT_EQ(in.beat_with({}), 1U);  // beat 5
  for (int beat = 6; beat <= 8; ++beat) EXPECT_EQ(in.beat_with({}), 0U);
  in.beat();
  EXPECT_EQ(in.pdos.expected(), 1U);
}

TEST(PdoInputs, NeverExpectEventDrivenPdosButWatchTheirDeadline) {
  for (const std::uint8_t type : std::vector<std::uint8_t>{0, 254, 255}) {
    BusPlan plan = test::axes({.nodes = 1, .tpdo_type = type});
    plan.pdos.tpdos[0].deadline = 9ms;
    Inputs in{plan};
    in.beat_with({1});  // at 2.3 ms
    for (int beat = 2; beat <= 5; ++beat) {
      in.beat();
      EXPECT_EQ(in.pdos.expected(), 0U);
      in.close();
    }
    EXPECT_TRUE(in.reported().empty());  // 10 ms + 1.2 ms - 2.3 ms
    in.beat_with({});
    in.beat_with({});
    const auto events = in.reported();
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].kind, EventKind::pdo_missing);
    EXPECT_TRUE(in.image.is_stale(0));
    in.beat_with({1});
    EXPECT_EQ(in.reported().size(), 1U);
    EXPECT_FALSE(in.image.is_stale(0));
  }
}

TEST(PdoInputs, ExpectNothingInACycleWhoseSyncWasNotSent) {
  Inputs in{test::axes({.nodes = 1})};
  in.beat_with({1});

  in.pdos.begin(2, 4ms, false);
  EXPECT_EQ(in.pdos.expected(), 0U);
  EXPECT_EQ(in.close(), 0U);

  in.beat();
  EXPECT_EQ(in.pdos.expected(), 1U);
}

TEST(PdoInputs, GrowStaleWhenTheirNodeLeaves) {
  Inputs in{test::axes({.nodes = 1})};
  in.beat_with({1});
  in.pdos.set_reception(0, Reception::off);
  EXPECT_TRUE(in.image.is_stale(0));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(in.beat_with({}), 0U);
  EXPECT_TRUE(in.reported().empty());
}

TEST(PdoInputs, WhileListeningWaitForNobodyButNoticeSilence) {
  Inputs in{test::axes({.nodes = 1}), Reception::listening};
  in.beat_with({1});
  in.beat();
  EXPECT_EQ(in.pdos.expected(), 0U);
  in.close();
  EXPECT_EQ(in.beat_with({}), 1U);
  EXPECT_TRUE(in.image.is_stale(0));
}

}  // namespace
}  // namespace takt
