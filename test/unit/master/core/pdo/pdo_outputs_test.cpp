// The values of RPDOs: commands, their age, and forced values.
#include <gtest/gtest.h>

#include "test/unit/master/core/pdo/outputs_rig.hpp"

namespace takt {
namespace {

BusPlan one_axis(std::uint8_t type = 1, bool seeds = false) {
  BusPlan plan = test::axes({.nodes = 1, .rpdo_type = type});
  if (!seeds) plan.layout.signals[3].seeded_from.reset();
  return plan;
}
constexpr std::size_t controlword = 0;
constexpr std::size_t target = 1;

TEST(PdoOutputs, PackControlwordAndTargetAsTheWireWantsThem) {
  OutputsRig out{one_axis()};
  out.command(controlword, 0x000F);
  out.command(target, -100000);

  const auto frames = out.pack();

  ASSERT_EQ(frames.size(), 1U);  // csp vector of the CiA 402 fact sheet
  EXPECT_EQ(frames[0], make_frame(CobId::base(0x201), {0x0F, 0x00, 0x60, 0x79, 0xFE, 0xFF}));
}

TEST(PdoOutputs, NeverSendAHalfCommandedRpdo) {
  OutputsRig out{one_axis()};
  EXPECT_TRUE(out.pack().empty());
  out.command(controlword, 0x000F);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(out.pack().empty());
  out.command(target, 5);
  EXPECT_EQ(out.pack().size(), 1U);
}

TEST(PdoOutputs, ReportAnRpdoThatStaysHalfCommandedOnce) {
  BusPlan plan = one_axis();
  for (Signal& signal : plan.layout.signals) signal.fallback_cycles = 0;
  OutputsRig out{plan};
  out.command(controlword, 0x000F);
  for (int i = 0; i < 30; ++i) out.pack();
  EXPECT_EQ(out.reported(), std::vector{EventKind::outputs_held});
}

TEST(PdoOutputs, SendASafeValueBeforeTheFirstCommand) {
  BusPlan plan = one_axis();
  plan.layout.signals[2].safe_value = 0x0006;
  plan.layout.signals[3].safe_value = 0;
  OutputsRig out{plan};
  const auto frames = out.pack();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0], make_frame(CobId::base(0x201), {0x06, 0, 0, 0, 0, 0}));
}

TEST(PdoOutputs, SeedTheTargetFromItsFeedback) {
  OutputsRig out{one_axis(1, true)};
  out.command(controlword, 0x0006);
  EXPECT_TRUE(out.pack().empty());  // no feedback so far

  out.feedback(1, {0x50, 0x02, 0x10, 0x27, 0, 0});
  const auto frames = out.pack();

  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0], make_frame(CobId::base(0x201), {0x06, 0, 0x10, 0x27, 0, 0}));
}

TEST(PdoOutputs, FollowTheFeedbackOnlyUntilTheNodeIsCommanded) {
  BusPlan plan = one_axis(1, true);
  plan.layout.signals[2].safe_value = 0;
  OutputsRig out{plan};
  out.feedback(1, {0, 0, 0x10, 0, 0, 0});
  EXPECT_EQ(out.pack().at(0).data[2], 0x10);
  out.feedback(1, {0, 0, 0x11, 0, 0, 0});
  EXPECT_EQ(out.pack().at(0).data[2], 0x11);

  out.command(controlword, 0x000F);
  out.feedback(1, {0, 0, 0x12, 0, 0, 0});  // the axis sags while it is being enabled
  EXPECT_EQ(out.pack().at(0).data[2], 0x11);
}

TEST(PdoOutputs, ForgetCommandsFromBeforeTheNodeCameBack) {
  OutputsRig out{one_axis()};
  out.command(controlword, 0x000F);
  out.command(target, 5);
  EXPECT_EQ(out.pack().size(), 1U);

  out.pdos.outputs().shut(0);
  out.command(target, 6);
  EXPECT_TRUE(out.pack().empty());
  out.pdos.outputs().open(0, out.points);
  EXPECT_TRUE(out.pack().empty());

  out.command(controlword, 0x0006);
  EXPECT_TRUE(out.pack().empty());
  out.command(target, 7);
  EXPECT_EQ(out.pack().at(0).data[2], 7);
}

TEST(PdoOutputs, FallBackWhenTheCommandOutlivesItsTime) {
  OutputsRig out{one_axis()};  // 3 cycles: controlword 0x0002, target held
  out.command(controlword, 0x000F);
  out.command(target, 5);
  for (int age = 0; age < 3; ++age) EXPECT_EQ(out.pack().at(0).data[0], 0x0F);
  EXPECT_TRUE(out.reported().empty());

  const auto frames = out.pack();

  EXPECT_EQ(frames.at(0), make_frame(CobId::base(0x201), {0x02, 0, 5, 0, 0, 0}));
  out.pack();
  EXPECT_EQ(out.reported(), std::vector{EventKind::fallback_begun});
  out.command(controlword, 0x000F);
  EXPECT_EQ(out.pack().at(0).data[0], 0x0F);
  EXPECT_EQ(out.reported(), std::vector{EventKind::fallback_ended});
}

TEST(PdoOutputs, TakeTheShorterOfTwoTimesToLive) {
  OutputsRig out{one_axis()};
  out.command(controlword, 0x000F, 1);
  out.command(target, 5, 100);
  EXPECT_EQ(out.pack().at(0).data[0], 0x0F);
  EXPECT_EQ(out.pack().at(0).data[0], 0x02);
  out.pack();
  out.reported();
  out.pack();
  EXPECT_EQ(out.reported(), std::vector{EventKind::fallback_begun});  // the target, after 3
}

TEST(PdoOutputs, CountMissedPeriodsAsAge) {
  OutputsRig out{one_axis()};
  out.command(controlword, 0x000F);
  out.command(target, 5);
  out.pack();
  out.skip(25);
  EXPECT_EQ(out.pack().at(0).data[0], 0x02);
}

TEST(PdoOutputs, NeverSendACommandThatWasTooOldWhenItWasSeen) {
  OutputsRig out{one_axis()};
  out.command(controlword, 0x000F);
  out.command(target, 5);
  out.pack();
  out.command(controlword, 0x001F);
  out.command(target, 6);
  out.skip(25);  // the bus thread did not run meanwhile
  const auto frames = out.pack();
  EXPECT_EQ(frames.at(0), make_frame(CobId::base(0x201), {0x02, 0, 5, 0, 0, 0}))
      << "the target is held as it was sent last";
  EXPECT_EQ(out.reported(), std::vector{EventKind::fallback_begun});
}

TEST(PdoOutputs, ALatchedCommandHasASecondUntilItIsSeen) {
  BusPlan plan = one_axis();
  for (Signal& signal : plan.layout.signals) signal.fallback_cycles = 0;
  OutputsRig out{plan};
  out.command(controlword, 0x000F);
  out.command(target, 5);
  out.pack();
  out.command(target, 6);
  out.skip(490);
  EXPECT_EQ(out.pack().at(0).data[2], 6);
  out.command(target, 7);
  out.skip(510);
  EXPECT_EQ(out.pack().at(0).data[2], 6);
}

TEST(PdoOutputs, ReleasedOutputsTakeTheirFallbackWithoutAWarning) {
  OutputsRig out{one_axis()};
  out.command(controlword, 0x000F);
  out.command(target, 5);
  out.pack();
  out.command(controlword, 0, output_released);
  out.command(target, 0, output_released);

  EXPECT_EQ(out.pack().at(0), make_frame(CobId::base(0x201), {0x02, 0, 5, 0, 0, 0}));
  out.skip(100);
  out.pack();
  out.command(controlword, 0x0006);
  EXPECT_EQ(out.pack().at(0).data[0], 0x06);
  EXPECT_TRUE(out.reported().empty());
}

/// After the release, nobody commands the axis. It has to come to rest before it is disabled.
TEST(PdoOutputs, AReleaseWaitsUntilTheMotionOfItsNodeHasEnded) {
  BusPlan plan = one_axis();
  for (Signal& signal : plan.layout.signals) signal.fallback_cycles = 10;
  OutputsRig out{plan};
  out.command(controlword, 0x000F);
  out.command(target, 5);
  out.pack();
  for (const std::int64_t position : {6, 7, 8}) {
    out.command(controlword, 0, output_released);
    out.command(target, 0, output_released);
    ASSERT_TRUE(out.pdos.outputs().lead(3, position, {.cycle = 1}));
    EXPECT_EQ(out.pack().at(0).data[0], 0x0F);
  }
  out.pdos.outputs().release_lead(3);
  EXPECT_EQ(out.pack().at(0), make_frame(CobId::base(0x201), {0x02, 0, 8, 0, 0, 0}));
}

/// Two axes of one device: the release of one does not wait for the other.
TEST(PdoOutputs, AReleaseDoesNotWaitForAnotherAxisOfItsNode) {
  BusPlan plan = test::axes({.nodes = 2, .fallback_cycles = 10});
  for (Signal& signal : plan.layout.signals) {
    if (signal.node_index == 1) signal.object.index += 0x800;
    signal.node_index = 0;
  }
  plan.pdos.rpdos[1].node_index = 0;
  constexpr SignalIndex second_target = 7;
  OutputsRig out{plan};
  for (const std::size_t word : {0U, 1U}) out.command(word, 0x000F);
  for (const std::size_t position : {2U, 3U}) out.command(position, 5);
  out.pack();
  for (std::size_t output = 0; output < 4; ++output) out.command(output, 0, output_released);
  ASSERT_TRUE(out.pdos.outputs().lead(second_target, 6, {.cycle = 1}));
  const std::vector<Frame> moving = out.pack();
  EXPECT_EQ(moving.at(0).data[0], 0x02) << "the first axis stands";
  EXPECT_EQ(moving.at(1).data[0], 0x0F);
  out.pdos.outputs().release_lead(second_target);
  EXPECT_EQ(out.pack().at(0).data[0], 0x02);
}

TEST(PdoOutputs, CommandWithoutTimeToLiveNeverGrowsOld) {
  BusPlan plan = one_axis();
  for (Signal& signal : plan.layout.signals) signal.fallback_cycles = 0;
  OutputsRig out{plan};
  out.command(controlword, 0x000F);
  out.command(target, 5);
  out.pack();
  out.skip(1'000'000);
  EXPECT_EQ(out.pack().at(0).data[0], 0x0F);
}

TEST(PdoOutputs, CommandFromTheCycleItselfIsAsGoodAsAnyOther) {
  OutputsRig out{one_axis()};
  out.pdos.outputs().command(2, 0x0F, 0, {.cycle = 1});
  out.pdos.outputs().command(3, 77, 0, {.cycle = 1});
  EXPECT_EQ(out.pack().at(0), make_frame(CobId::base(0x201), {0x0F, 0, 77, 0, 0, 0}));
  out.pdos.outputs().command(0, 1, 0, {.cycle = 1});     // an input
  out.pdos.outputs().command(9999, 1, 0, {.cycle = 1});  // no signal
}

TEST(PdoOutputs, WhileStoppingHearNoCommandAndSendWhatIsForced) {
  OutputsRig out{one_axis()};
  out.command(controlword, 0x000F);
  out.command(target, 5);
  out.pack();
  out.pdos.outputs().fall_back();
  out.command(controlword, 0x001F);
  EXPECT_EQ(out.pack().at(0).data[0], 0x02);
  out.pdos.outputs().force(2, 0x0000);
  EXPECT_EQ(out.pack().at(0).data[0], 0x00);
}

TEST(PdoOutputs, KeepTheFallbackUntilTheNextCommandWhenCommandsAreHeardAgain) {
  OutputsRig out{one_axis()};
  out.command(controlword, 0x000F);
  out.command(target, 5);
  out.pack();
  out.pdos.outputs().fall_back();
  out.command(controlword, 0x001F);
  out.pack();

  out.pdos.outputs().hear_again();
  EXPECT_EQ(out.pack().at(0).data[0], 0x02);
  EXPECT_EQ(out.pack().at(0).data[0], 0x02);
  out.command(controlword, 0x000F);
  EXPECT_EQ(out.pack().at(0).data[0], 0x0F);
}

TEST(PdoOutputs, KeepWhatWasForcedUntilTheNextCommandHoweverLateItComes) {
  OutputsRig out{one_axis()};
  out.command(controlword, 0x000F);
  out.command(target, 5);
  out.pack();
  out.pdos.outputs().force(2, 0x0002);
  for (int i = 0; i < 20; ++i) out.pack();
  out.reported();

  out.pdos.outputs().release(2);
  EXPECT_EQ(out.pack().at(0).data[0], 0x02);
  EXPECT_TRUE(out.reported().empty());
}

TEST(PdoOutputs, HearNoCommandFromTheTimeOfAForcedValue) {
  BusPlan plan = one_axis();
  for (Signal& signal : plan.layout.signals) signal.fallback_cycles = 0;
  OutputsRig out{plan};
  out.command(controlword, 0x000F);
  out.command(target, 5);
  out.pack();
  out.pdos.outputs().force(2, 0x0002);
  out.command(controlword, 0x001F);
  out.pack();

  out.pdos.outputs().release(2);
  EXPECT_EQ(out.pack().at(0).data[0], 0x02);
  out.command(controlword, 0x000F);
  EXPECT_EQ(out.pack().at(0).data[0], 0x0F);
}

}  // namespace
}  // namespace takt
