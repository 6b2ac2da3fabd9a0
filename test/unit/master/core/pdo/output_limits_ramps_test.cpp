// Limits of a target velocity in the mode in which the drive has ramps of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/master/core/pdo/axis_with_modes.hpp"

namespace takt::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr AxisPair velocities{AxisQuantity::velocity, 0x60FF, 0x60B1, LimitKind::velocity};
constexpr std::int8_t profile_velocity = 3;
constexpr std::int8_t cyclic_velocity = 9;
/// A count per cycle, which is 25 counts in 50 ms.
constexpr OutputLimit accelerating{
    .low = -100, .high = 100, .rate = 1, .rate_of = LimitKind::acceleration};

class RampingAxis : public AxisWithModes {
 public:
  /// In this fixture, the actual velocity is at the place of the actual position.
  explicit RampingAxis(bool measured = true) : AxisWithModes{limit(measured), velocities} {
    set(order_output, enable_operation);
    set(offset_output, 0);
    send(0, profile_velocity);
  }
  /// Commands a velocity and a mode while the drive shows the mode `shown`.
  void send(std::int64_t velocity, std::int8_t mode, std::int8_t shown) {
    feedback(actual_, enabled, shown);
    set(mode_output, mode);
    set(target_output, velocity);
    cycle();
  }
  void send(std::int64_t velocity, std::int8_t mode) { send(velocity, mode, mode); }
  void turn(std::int32_t actual) { actual_ = actual; }

 private:
  static OutputLimit limit(bool measured) {
    OutputLimit made = accelerating;
    if (measured) made.feedback = SignalIndex{1};
    return made;
  }

  std::int32_t actual_ = 0;
};

TEST(LimitsWithRamps, LetATargetVelocityStepAndKeepItsRange) {
  RampingAxis axis;
  axis.send(100, profile_velocity);
  axis.send(-100, profile_velocity);
  EXPECT_EQ(axis.target(), -100);
  EXPECT_THAT(axis.refusals(), IsEmpty());

  axis.send(101, profile_velocity);
  EXPECT_EQ(axis.target(), -100);
  EXPECT_THAT(axis.refusals(), ElementsAre(HasSubstr("velocity 0.101, limit 0.1")));
}

TEST(LimitsWithRamps, CountStepsUnlessTheModeIsCommandedAndShown) {
  for (const auto& [mode, shown] : {std::pair{cyclic_velocity, cyclic_velocity},
                                    {profile_velocity, cyclic_velocity},
                                    {cyclic_velocity, profile_velocity}}) {
    RampingAxis axis;
    axis.send(0, mode, shown);
    axis.send(2, mode, shown);
    EXPECT_EQ(axis.target(), 0);
    EXPECT_THAT(axis.refusals(), ElementsAre(HasSubstr("acceleration")));
  }
}

TEST(LimitsWithRamps, LetNoModeMakeAJumpOfATargetThatTheDriveHasNotReached) {
  RampingAxis axis;
  axis.send(90, profile_velocity);
  axis.turn(20);
  axis.set(mode_output, cyclic_velocity);
  axis.feedback(20, enabled, profile_velocity);
  axis.cycle();
  EXPECT_EQ(axis.controlword(), quick_stop);
  EXPECT_THAT(axis.refusals(), ElementsAre(HasSubstr(", which is outside its limits: ")));
}

TEST(LimitsWithRamps, LetTheNextModeBeginNearTheActualVelocity) {
  RampingAxis axis;
  axis.send(90, profile_velocity);
  axis.turn(20);
  axis.send(45, cyclic_velocity, profile_velocity);
  axis.send(46, cyclic_velocity);
  EXPECT_EQ(axis.target(), 46);
  EXPECT_THAT(axis.refusals(), IsEmpty());

  RampingAxis other;
  other.send(90, profile_velocity);
  other.turn(20);
  other.send(46, cyclic_velocity, profile_velocity);
  EXPECT_EQ(other.target(), 90);
  EXPECT_EQ(other.refusals().size(), 1U);
}

TEST(LimitsWithRamps, CountTheValueThatWasSentLastWhereNoVelocityIsMeasured) {
  RampingAxis axis{false};
  axis.send(90, profile_velocity);
  axis.send(91, cyclic_velocity, profile_velocity);
  EXPECT_EQ(axis.target(), 91);
  axis.send(93, cyclic_velocity);
  EXPECT_EQ(axis.target(), 91);
  EXPECT_EQ(axis.refusals().size(), 1U);
}

TEST(LimitsWithRamps, BeginAtTheActualVelocityAfterTheBoot) {
  for (const std::int32_t first : {25, 26}) {
    AxisWithModes axis{[] {
                         OutputLimit limit = accelerating;
                         limit.feedback = SignalIndex{1};
                         return limit;
                       }(),
                       velocities};
    axis.feedback(0, enabled, cyclic_velocity);
    axis.set(order_output, enable_operation);
    axis.set(mode_output, cyclic_velocity);
    axis.set(target_output, first);
    axis.cycle();
    EXPECT_EQ(axis.refusals().size(), first == 25 ? 0U : 1U) << first;
  }
}

TEST(LimitsWithRamps, CountNoStepsWhereTheFileSetsTheMode) {
  for (const std::int64_t mode : {std::int64_t{profile_velocity}, std::int64_t{cyclic_velocity}}) {
    OutputLimit limit = accelerating;
    limit.fixed_mode = mode;
    LimitedAxes axes{1, limit, [](BusPlan& plan) {
                       plan.limits.outputs[0].quantity = AxisQuantity::velocity;
                       plan.limits.outputs[0].feedback.reset();
                       plan.limits.outputs[0].controlword.reset();
                     }};
    axes.cycle_with(0, 0);
    axes.cycle_with(0, 100);
    EXPECT_EQ(axes.refusals(), mode == cyclic_velocity ? 1U : 0U) << mode;
  }
}

}  // namespace
}  // namespace takt::test
