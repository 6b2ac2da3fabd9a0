// Limits at the moment at which an axis is enabled or changes its mode.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vector>

#include "test/unit/master/core/pdo/axis_with_modes.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;

TEST(LimitsAtEnabling, LetNoTargetOfADisabledAxisLeaveTheActualPosition) {
  LimitedAxes axes{1, stepping};
  axes.feedback(0, 0, disabled);
  for (int i = 1; i <= 30; ++i) {
    axes.command(0, 4 * i, 0x0006);
    axes.cycle();
    EXPECT_LE(axes.position(), 10);
  }
  EXPECT_EQ(axes.refusals(), 1U);
}

TEST(LimitsAtEnabling, LetATargetFollowAnAxisThatIsPushed) {
  LimitedAxes axes{1, stepping};
  for (int i = 0; i <= 30; ++i) {
    axes.feedback(0, 9 * i, disabled);
    axes.command(0, 9 * std::max(0, i - 3), 0x0006);  // computed from an older image
    axes.cycle();
  }
  EXPECT_EQ(axes.position(), 243);
  EXPECT_EQ(axes.refusals(), 0U);
}

/// An axis whose target stays at 8 while it is pushed to `position`.
class PushedAxis : public LimitedAxes {
 public:
  PushedAxis(std::int32_t position, std::uint16_t statusword, void (*change)(BusPlan&) = nullptr)
      : LimitedAxes{1, stepping, change} {
    feedback(0, 8, disabled);
    command(0, 8, 0x0007);
    cycle();
    feedback(0, position, statusword);
    cycle();
  }
};

TEST(LimitsAtEnabling, RefuseTheControlwordIfTheTargetIsNotAtTheActualPosition) {
  for (const std::uint16_t statusword :
       {switched_on, disabled, std::uint16_t{0x0031}, std::uint16_t{0x0007}}) {
    PushedAxis axes(500, statusword);
    axes.set(0, enable_operation);
    axes.cycle();
    EXPECT_EQ(axes.controlword(), quick_stop) << statusword;
    EXPECT_EQ(axes.position(), 8);

    std::vector<Event> reported = axes.reported();
    std::erase_if(reported, [](const Event& one) { return one.kind != EventKind::limit_exceeded; });
    ASSERT_EQ(reported.size(), 1U);
    EXPECT_THAT(
        describe(axes.plan(), reported[0]),
        HasSubstr("signal (607A:00) still has the set-point 0.008 rad, which is outside its "
                  "limits: step 0.492, limit 0.01; takt does not send the command that "
                  "would make the axis follow this set-point"));
  }
}

TEST(LimitsAtEnabling, SendTheControlwordTogetherWithTheActualPosition) {
  PushedAxis axes(500, switched_on);
  axes.cycle_with(0, 503);
  EXPECT_EQ(axes.controlword(), enable_operation);
  EXPECT_EQ(axes.position(), 503);
  EXPECT_EQ(axes.refusals(), 0U);
}

TEST(LimitsAtEnabling, SendTheControlwordAloneIfTheTargetIsAtTheActualPosition) {
  PushedAxis axes(15, switched_on);
  axes.set(0, enable_operation);
  axes.cycle();
  EXPECT_EQ(axes.controlword(), enable_operation);
  EXPECT_EQ(axes.refusals(), 0U);
}

TEST(LimitsAtEnabling, TakeOtherControlwordsWhereverTheTargetIs) {
  PushedAxis axes(500, disabled);
  for (const std::int64_t order : {0x06, 0x07, 0x80}) {
    axes.set(0, order);
    axes.cycle();
    EXPECT_EQ(axes.controlword(), order);
  }
  EXPECT_EQ(axes.refusals(), 0U);
}

TEST(LimitsAtEnabling, HoldForAControllerInTheBusThreadWhateverItsOrder) {
  PushedAxis axes(500, switched_on);
  axes.write(0, enable_operation);
  axes.write(1, 502);
  axes.cycle();
  EXPECT_EQ(axes.controlword(), enable_operation);
  EXPECT_EQ(axes.position(), 502);

  PushedAxis others(500, switched_on);
  for (int i = 0; i < 200; ++i) {
    others.write(0, enable_operation);
    others.cycle();
    EXPECT_EQ(others.controlword(), quick_stop);
  }
  EXPECT_EQ(others.refusals(), 1U);
}

TEST(LimitsAtEnabling, SendTheLastControlwordAgainWhereTheFallbackKeepsIt) {
  PushedAxis axes(500, switched_on,
                  [](BusPlan& plan) { plan.layout.signals[2].fallback = Fallback::hold; });
  axes.write(0, enable_operation);
  axes.cycle();
  EXPECT_EQ(axes.controlword(), 0x0007);
  EXPECT_EQ(axes.refusals(), 1U);
}

TEST(LimitsAtEnabling, UseTheControlwordWhereNoStatuswordIsMapped) {
  LimitedAxes axes{1, stepping, [](BusPlan& plan) { plan.limits.outputs[0].statusword.reset(); }};
  axes.command(0, 8, 0x0007);
  axes.cycle();
  axes.command(0, 16, 0x0007);
  axes.cycle();
  EXPECT_EQ(axes.position(), 8);
  axes.feedback(0, 500);
  for (int i = 0; i < 60; ++i) axes.cycle();
  axes.set(0, enable_operation);
  axes.cycle();
  EXPECT_EQ(axes.controlword(), quick_stop);
  EXPECT_EQ(axes.refusals(), 2U);
}

TEST(LimitsAtEnabling, LetAMotionGoOnWhileTheDriveReportsAFault) {
  LimitedAxes axes{1, stepping};
  for (int i = 1; i <= 20; ++i) {
    if (i == 10) axes.feedback(0, 50, in_fault);
    axes.cycle_with(0, 9 * i);
  }
  EXPECT_EQ(axes.position(), 180);
  EXPECT_EQ(axes.refusals(), 0U);

  axes.set(0, 0x0080);
  axes.cycle();
  axes.feedback(0, 50, disabled);
  axes.set(0, enable_operation);
  axes.cycle();
  EXPECT_EQ(axes.controlword(), quick_stop);
  EXPECT_EQ(axes.refusals(), 1U);
}

TEST(LimitsAtEnabling, MeasureFromTheLastTargetIfTheActualPositionIsUnknown) {
  PushedAxis axes(500, switched_on, [](BusPlan& plan) { plan.limits.outputs[0].feedback.reset(); });
  axes.cycle_with(0, 16);
  EXPECT_EQ(axes.controlword(), enable_operation);
  EXPECT_EQ(axes.position(), 16);
}

/// Returns the controlword that is sent when an axis is to be enabled in `mode`, 500 counts away
/// from its target.
std::int64_t enabled_in(int mode, int shown) {
  AxisWithModes axis{{.step = 10, .wraps = true}};
  axis.feedback(8, disabled, static_cast<std::int8_t>(shown));
  axis.set(order_output, 0x0007);
  axis.set(target_output, 8);
  axis.set(mode_output, mode);
  axis.cycle();
  axis.feedback(508, switched_on, static_cast<std::int8_t>(shown));
  axis.set(order_output, enable_operation);
  axis.cycle();
  EXPECT_EQ(axis.target(), 8);
  return axis.controlword();
}

TEST(LimitsAtEnabling, LookAtTheModeBecauseOnlySomeFollowTheTarget) {
  for (const int mode : {1, 2, 3, 4, 6, 9, 10}) {
    EXPECT_EQ(enabled_in(mode, mode), enable_operation) << mode;
    EXPECT_EQ(enabled_in(mode, 8), quick_stop) << "the drive still shows another mode";
  }
  for (const int mode : {7, 8, 0, -1}) {
    EXPECT_EQ(enabled_in(mode, mode), quick_stop) << mode;
  }
}

TEST(OutputLimits, LetNoChangeFromAVelocityModeJumpToAnOldTarget) {
  AxisWithModes axis{{.step = 10, .wraps = true}};
  axis.feedback(0, enabled, 9);
  axis.set(order_output, enable_operation);
  axis.set(target_output, 0);
  axis.set(mode_output, 9);
  axis.cycle();
  axis.feedback(700, enabled, 9);  // the axis has turned
  axis.set(mode_output, 8);
  axis.cycle();
  EXPECT_EQ(axis.controlword(), quick_stop);
  EXPECT_EQ(axis.refusals().size(), 1U);
}

}  // namespace
}  // namespace takt::test
