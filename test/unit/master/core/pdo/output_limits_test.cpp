// Checks commands against the limits of their outputs when the outputs are packed.
#include <cstring>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vector>

#include "master/explain/boot_report.hpp"
#include "test/unit/master/core/pdo/limited_axes.hpp"

namespace takt::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

float float_at(const Event& event, std::size_t place) {
  float value = 0;
  std::memcpy(&value, event.bytes.data() + place, 4);
  return value;
}

TEST(OutputLimits, LetThroughWhatIsInside) {
  LimitedAxes axes{1, {.low = -100, .high = 100, .step = 10, .rate = 10, .wraps = true}};
  for (int i = 1; i <= 10; ++i) {
    axes.cycle_with(0, 10 * i);
    EXPECT_EQ(axes.position(), 10 * i);
  }
  EXPECT_EQ(axes.refusals(), 0U);
}

TEST(OutputLimits, DoNotSendAJumpAndStopTheAxisInTheSameCycle) {
  LimitedAxes axes{1, stepping};
  axes.cycle_with(0, 5);
  axes.cycle_with(0, 505);
  EXPECT_EQ(axes.position(), 5);
  EXPECT_EQ(axes.controlword(), quick_stop);

  const std::vector<Event> reported = axes.reported();
  ASSERT_EQ(reported.size(), 1U);
  EXPECT_EQ(reported[0].kind, EventKind::limit_exceeded);
  EXPECT_EQ(reported[0].node, 1);
  EXPECT_EQ(reported[0].value, 505);
  EXPECT_EQ(reported[0].detail, 3U << 8U | static_cast<unsigned>(LimitKind::step));
  EXPECT_FLOAT_EQ(float_at(reported[0], 0), 0.5F);  // rad
  EXPECT_FLOAT_EQ(float_at(reported[0], 4), 0.01F);
}

TEST(OutputLimits, ReportAStreamOutsideOnceAndHearNothingOfItsNodeMeanwhile) {
  LimitedAxes axes{1, stepping};
  axes.cycle_with(0, 5);
  for (int i = 0; i < 40; ++i) axes.cycle_with(0, 505 + i);
  EXPECT_EQ(axes.position(), 5);
  EXPECT_EQ(axes.controlword(), quick_stop);
  axes.set(0, enable_operation);  // sent alone; the refused target still counts
  axes.cycle();
  EXPECT_EQ(axes.controlword(), quick_stop);
  EXPECT_EQ(axes.refusals(), 1U);
}

TEST(OutputLimits, HearTheNodeAgainFromTheNextCommandInside) {
  LimitedAxes axes{1, stepping};
  axes.cycle_with(0, 5);
  axes.cycle_with(0, 505);
  axes.cycle_with(0, 12);
  EXPECT_EQ(axes.position(), 12);
  EXPECT_EQ(axes.controlword(), enable_operation);
}

TEST(OutputLimits, HearNothingBeforeTheFallbackWasSent) {
  LimitedAxes axes{1, stepping};
  axes.cycle_with(0, 5);
  axes.lose_frames(true);  // a cycle without outputs
  axes.cycle_with(0, 505);
  axes.lose_frames(false);
  axes.cycle_with(0, 12);
  EXPECT_EQ(axes.position(), 5);
  EXPECT_EQ(axes.controlword(), quick_stop);
  axes.cycle_with(0, 12);
  EXPECT_EQ(axes.position(), 12);
  EXPECT_EQ(axes.controlword(), enable_operation);
}

TEST(OutputLimits, HearTheNodeAgainWhenTheRefusedCommandHasGrownOld) {
  LimitedAxes axes{1, stepping};
  axes.cycle_with(0, 5);
  axes.cycle_with(0, 505);
  for (int i = 0; i < 60; ++i) axes.cycle();
  axes.set(0, enable_operation);
  axes.cycle();
  EXPECT_EQ(axes.controlword(), enable_operation);
  EXPECT_EQ(axes.position(), 5);
}

TEST(OutputLimits, MeasureStepsOverTheCyclesOfLostMessages) {
  LimitedAxes axes{1, stepping};
  axes.cycle_with(0, 10);
  axes.cycle();  // the command for 20 is lost
  axes.cycle_with(0, 30);
  EXPECT_EQ(axes.position(), 30);
  axes.cycle();
  axes.cycle();
  axes.cycle_with(0, 61);
  EXPECT_EQ(axes.position(), 30);
  EXPECT_EQ(axes.refusals(), 1U);
}

TEST(OutputLimits, LetNoSilenceSaveUpMoreThanFiftyMilliseconds) {
  LimitedAxes axes{1, stepping};
  axes.cycle_with(0, 10);
  for (int i = 0; i < 40; ++i) axes.cycle();
  axes.cycle_with(0, 261);  // 25 cycles of 2 ms, 10 counts each
  EXPECT_EQ(axes.position(), 10);
  EXPECT_EQ(axes.refusals(), 1U);
}

TEST(OutputLimits, LetNoRepeatedCommandSaveUpAStep) {
  LimitedAxes axes{1, stepping};
  for (int i = 0; i < 20; ++i) axes.cycle_with(0, 10);
  axes.cycle_with(0, 21);
  EXPECT_EQ(axes.position(), 10);
}

TEST(OutputLimits, MeasureFromWhatWasSentNotFromWhatWasCommanded) {
  LimitedAxes axes{1, stepping};
  axes.cycle_with(0, 0);
  axes.lose_frames(true);
  axes.cycle_with(0, 10);
  axes.lose_frames(false);
  axes.cycle_with(0, 20);
  EXPECT_EQ(axes.position(), 20);  // two cycles since 0 went out
  EXPECT_EQ(axes.refusals(), 0U);
}

TEST(OutputLimits, HoldTheFirstCommandAgainstTheActualPosition) {
  LimitedAxes axes{1, stepping};
  axes.feedback(0, 1000);
  axes.cycle();
  axes.cycle_with(0, 1500);
  EXPECT_NE(axes.position(), 1500);
  axes.cycle_with(0, 1008);
  EXPECT_EQ(axes.position(), 1008);
}

TEST(OutputLimits, LetTheFirstCommandWaitForTheActualPosition) {
  LimitedAxes axes{1, stepping};
  axes.cycle_with(0, 3);
  axes.boot(0);
  axes.cycle_with(0, 1500);
  axes.write(1, 1500);
  axes.cycle();
  EXPECT_EQ(axes.position(), 3) << "nothing goes out";
  axes.feedback(0, 1000);
  axes.cycle();
  EXPECT_EQ(axes.position(), 1000);
  axes.cycle_with(0, 1008);
  EXPECT_EQ(axes.position(), 1008);
  EXPECT_EQ(axes.refusals(), 0U);
}

TEST(OutputLimits, ReportWhichActualPositionTheFirstCommandWaitsFor) {
  const auto text_with = [](std::uint8_t transmission) {
    LimitedAxes axes{1, stepping};
    axes.boot(0);
    for (int i = 0; i < 12; ++i) axes.cycle_with(0, 1500);
    for (const Event& event : axes.reported()) {
      if (event.kind != EventKind::outputs_held) continue;
      BusPlan plan = axes.plan();
      plan.pdos.tpdos[0].transmission = transmission;
      return describe(plan, event);
    }
    return std::string{"nothing"};
  };
  EXPECT_THAT(text_with(255),
              AllOf(HasSubstr("RPDO1 is held back until "),
                    HasSubstr("(6064:00) has come from the device for the first time"),
                    HasSubstr("TPDO1 only by event: give the TPDO an `event_timer`, or make it "
                              "synchronous (`transmission: 1`)")));
  EXPECT_THAT(text_with(1), HasSubstr("check whether the device sends TPDO1"));
}

TEST(OutputLimits, LetADisabledAxisFollowItsActualPosition) {
  LimitedAxes axes{1, stepping};
  axes.cycle_with(0, 5);
  axes.feedback(0, 700, 0x0040);  // moved by hand
  axes.cycle_with(0, 700);
  EXPECT_EQ(axes.position(), 700);
  axes.feedback(0, 700, 0x0027);
  axes.cycle_with(0, 5);  // the axis is enabled, and there is no jump back
  EXPECT_EQ(axes.position(), 700);
}

TEST(OutputLimits, LetAnAxisComeBackFromOutsideButNotGoFurther) {
  LimitedAxes axes{1, {.low = -100, .high = 100, .step = 50, .wraps = true}};
  axes.feedback(0, 180, 0x0040);
  axes.cycle_with(0, 180);
  EXPECT_EQ(axes.position(), 180);
  axes.feedback(0, 180, 0x0027);
  axes.cycle_with(0, 150);
  EXPECT_EQ(axes.position(), 150);
  axes.cycle_with(0, 160);
  EXPECT_EQ(axes.position(), 150);
  EXPECT_EQ(axes.refusals(), 1U);
  axes.cycle_with(0, 100);
  EXPECT_EQ(axes.position(), 100);
  axes.cycle_with(0, 101);
  EXPECT_EQ(axes.position(), 100);
}

TEST(OutputLimits, TakeTheShorterWayAroundTheWidthOfTheObject) {
  LimitedAxes axes{1, stepping};
  axes.feedback(0, 2147483640);
  axes.cycle();
  axes.cycle_with(0, 2147483645);
  EXPECT_EQ(axes.position(), 2147483645);
  axes.cycle_with(0, -2147483646);  // 5 counts further
  EXPECT_EQ(axes.position(), -2147483646);
  EXPECT_EQ(axes.refusals(), 0U);
}

TEST(OutputLimits, TakeTheShorterWayAroundTheRangeOfARotaryAxis) {
  LimitedAxes axes{1, {.step = 10, .modulus = 3600}};
  axes.feedback(0, 3595);
  axes.cycle();
  axes.cycle_with(0, 3598);
  axes.cycle_with(0, 4);
  EXPECT_EQ(axes.position(), 4);
  axes.cycle_with(0, 1804);
  EXPECT_EQ(axes.position(), 4);
}

TEST(OutputLimits, DoNotTakeWholeTurnsOfARotaryAxisForNoWay) {
  LimitedAxes axes{1, {.step = 10, .modulus = 3600}};
  axes.feedback(0, 5);
  axes.cycle();
  axes.cycle_with(0, 8);
  for (const std::int64_t turns : {1, -1, 2, 200}) {
    axes.cycle_with(0, 8 + turns * 3600);
    EXPECT_EQ(axes.position(), 8) << turns << " turns";
    axes.cycle_with(0, 8);
    axes.cycle_with(0, 8);
  }
  EXPECT_EQ(axes.refusals(), 4U);
}

TEST(OutputLimits, JudgeWhatTheWireWouldCarry) {
  LimitedAxes axes{1, {.low = -100, .high = 100}};
  axes.write(0, enable_operation);
  axes.write(1, (1LL << 32) + 90);  // 90 in 32 bits
  axes.cycle();
  EXPECT_EQ(axes.position(), 90);
  axes.write(1, 0x8000'0000LL);  // the most negative number
  axes.cycle();
  EXPECT_EQ(axes.position(), 90);
  EXPECT_EQ(axes.refusals(), 1U);
}

TEST(OutputLimits, SeeTheSecondDifference) {
  LimitedAxes axes{1, {.bend = 5, .wraps = true}};
  std::int64_t position = 0;
  for (int speed = 0; speed <= 40; speed += 5) axes.cycle_with(0, position += speed);
  EXPECT_EQ(axes.refusals(), 0U);
  axes.cycle();
  axes.cycle_with(0, position += 80);  // one message was lost
  EXPECT_EQ(axes.refusals(), 0U);
  axes.cycle_with(0, position + 60);  // 20 counts faster in one cycle
  EXPECT_EQ(axes.position(), position);
  EXPECT_EQ(axes.refusals(), 1U);
}

// An acceleration of 2 counts per cycle and cycle allows 2 * 25 * 25 counts in 50 ms, which are 25
// cycles.
TEST(OutputLimits, OfTheAccelerationAloneHoldTheFirstCommandToo) {
  LimitedAxes axes{1, {.bend = 2, .wraps = true}};
  axes.cycle_with(0, 2 * 25 * 25 + 1);
  EXPECT_NE(axes.controlword(), enable_operation);
  const std::vector<Event> reported = axes.reported();
  ASSERT_FALSE(reported.empty());
  EXPECT_EQ(reported[0].kind, EventKind::limit_exceeded);

  LimitedAxes near{1, {.bend = 2, .wraps = true}};
  near.cycle_with(0, 2 * 25 * 25);
  EXPECT_EQ(near.position(), 2 * 25 * 25);
  EXPECT_EQ(near.controlword(), enable_operation);
}

TEST(OutputLimits, LetOneAxisStopNoOther) {
  LimitedAxes axes{2, stepping};
  axes.command(0, 5);
  axes.command(1, 5);
  axes.cycle();
  axes.command(0, 500);
  axes.command(1, 10);
  axes.cycle();
  EXPECT_EQ(axes.controlword(0), quick_stop);
  EXPECT_EQ(axes.controlword(1), enable_operation);
  EXPECT_EQ(axes.position(1), 10);
}

TEST(OutputLimits, StopEveryAxisOfOneDevice) {
  LimitedAxes axes{2, stepping, [](BusPlan& plan) {
                     for (Signal& signal : plan.layout.signals) signal.node_index = 0;
                     for (PdoRow& row : plan.pdos.rpdos) row.node_index = 0;
                     for (PdoRow& row : plan.pdos.tpdos) row.node_index = 0;
                   }};
  axes.feedback(0, 0);
  axes.feedback(1, 0);
  axes.command(0, 5);
  axes.command(1, 5);
  axes.cycle();
  ASSERT_EQ(axes.position(1), 5);
  axes.command(0, 10);
  axes.command(1, 500);
  axes.cycle();
  EXPECT_EQ(axes.controlword(0), quick_stop);
  EXPECT_EQ(axes.controlword(1), quick_stop);
  EXPECT_EQ(axes.position(0), 5);
  EXPECT_EQ(axes.position(1), 5);
}

TEST(OutputLimits, HoldForAControllerInTheBusThreadToo) {
  LimitedAxes axes{1, stepping};
  axes.write(0, enable_operation);
  axes.write(1, 5);
  axes.cycle();
  axes.write(1, 505);
  axes.write(0, enable_operation);  // later in the same cycle
  axes.write(1, 6);
  axes.cycle();
  EXPECT_EQ(axes.position(), 5);
  EXPECT_EQ(axes.controlword(), quick_stop);
  axes.write(1, 8);
  axes.write(0, enable_operation);
  axes.cycle();
  EXPECT_EQ(axes.position(), 8);
  EXPECT_EQ(axes.controlword(), enable_operation);
}

TEST(OutputLimits, LetNoTwoCommandsOfOneCycleMakeOneStep) {
  LimitedAxes axes{1, stepping};
  axes.write(0, enable_operation);
  axes.write(1, 5);
  axes.cycle();
  axes.write(1, 14);
  axes.write(1, 23);
  axes.cycle();
  EXPECT_EQ(axes.controlword(), quick_stop);
  EXPECT_LE(axes.position(), 15);
}

TEST(OutputLimits, LetASenderGiveItsAxisUpWithoutAWord) {
  LimitedAxes axes{1, stepping};
  axes.feedback(0, 700);
  axes.cycle();
  axes.cycle_with(0, 705);
  axes.release(0);  // the values are no longer in use
  axes.release(1);
  axes.cycle();
  EXPECT_EQ(axes.position(), 705);
  EXPECT_EQ(axes.controlword(), quick_stop);
  EXPECT_EQ(axes.refusals(), 0U);
}

TEST(OutputLimits, ForgetWhatWasSentBeforeTheNodeCameBack) {
  LimitedAxes axes{1, {.step = 10, .wraps = true}, [](BusPlan& plan) {
                     plan.limits.outputs[0].feedback.reset();
                     plan.layout.signals[3].seeded_from.reset();
                   }};
  axes.cycle_with(0, 700);  // there is no reference for a check
  EXPECT_EQ(axes.position(), 700);
  axes.cycle_with(0, 711);
  EXPECT_EQ(axes.position(), 700);
}

TEST(OutputLimits, ReportAMagnitudeWithoutTheOffsetOfItsUnit) {
  const auto reported = [](LimitKind kind) {
    LimitedAxes axes{1, {.low = -100, .high = 100, .range = kind}, [](BusPlan& plan) {
                       plan.layout.signals[3].offset = 5;
                     }};
    axes.cycle_with(0, 101);
    const auto events = axes.reported();
    return events.empty() ? std::string{} : describe(axes.plan(), events[0]);
  };
  EXPECT_THAT(reported(LimitKind::velocity), testing::HasSubstr("velocity 0.101, limit 0.1;"));
  EXPECT_THAT(reported(LimitKind::position), testing::HasSubstr("position 5.101, limit 5.1;"));
}

}  // namespace
}  // namespace takt::test
