// Limits of the sum of a target velocity or torque and its offset.
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>

#include "test/unit/master/core/pdo/axis_with_modes.hpp"

namespace takt::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr AxisPair velocities{AxisQuantity::velocity, 0x60FF, 0x60B1, LimitKind::velocity};
constexpr AxisPair torques{AxisQuantity::torque, 0x6071, 0x60B2, LimitKind::torque};
constexpr std::int8_t cyclic_position = 8;
constexpr std::int8_t cyclic_velocity = 9;
constexpr std::int8_t cyclic_torque = 10;
const OutputLimit within_100{.low = -100, .high = 100};

/// An axis that follows a target of 0 in this mode.
class SummingAxis : public AxisWithModes {
 public:
  SummingAxis(const OutputLimit& limit, AxisPair pair, std::int8_t mode)
      : AxisWithModes{limit, pair}, mode_{mode} {
    send(0, 0);
  }
  void send(std::int64_t target, std::int64_t offset) {
    feedback(0, enabled, mode_);
    set(order_output, enable_operation);
    set(mode_output, mode_);
    set(target_output, target);
    set(offset_output, offset);
    cycle();
  }
  void go_to(std::int8_t mode) { mode_ = mode; }

 private:
  std::int8_t mode_;
};

TEST(LimitsOfSums, HoldTargetVelocityAndOffsetTogetherInTheRange) {
  SummingAxis axis{within_100, velocities, cyclic_velocity};
  axis.send(60, 40);
  axis.send(-50, 150);
  EXPECT_EQ(axis.target(), -50);
  EXPECT_EQ(axis.offset(), 150);
  EXPECT_THAT(axis.refusals(), IsEmpty());

  axis.send(60, 41);
  EXPECT_EQ(axis.target(), -50);
  EXPECT_EQ(axis.offset(), 150);
  EXPECT_EQ(axis.controlword(), quick_stop);
  EXPECT_THAT(axis.refusals(),
              ElementsAre(HasSubstr("(60FF:00) is outside its limits: velocity 0.101")));
}

TEST(LimitsOfSums, HoldTargetTorqueAndOffsetTogetherInTheRange) {
  SummingAxis axis{within_100, torques, cyclic_torque};
  axis.send(-60, -40);
  EXPECT_EQ(axis.offset(), -40);
  axis.send(-60, -41);
  EXPECT_EQ(axis.offset(), -40);
  EXPECT_THAT(axis.refusals(), ElementsAre(HasSubstr("torque -0.101, limit -0.1")));
}

TEST(LimitsOfSums, HoldTheAccelerationOfTheSum) {
  SummingAxis axis{{.rate = 10, .rate_of = LimitKind::acceleration}, velocities, cyclic_velocity};
  axis.send(5, 5);
  axis.send(-20, 40);
  EXPECT_EQ(axis.offset(), 40);
  EXPECT_THAT(axis.refusals(), IsEmpty());

  axis.send(-14, 46);
  EXPECT_EQ(axis.offset(), 40);
  EXPECT_EQ(axis.refusals().size(), 1U);
}

TEST(LimitsOfSums, HoldTheOffsetOfAControllerInTheBusThread) {
  SummingAxis axis{within_100, velocities, cyclic_velocity};
  axis.write(target_output, 60);
  axis.write(offset_output, 40);
  axis.cycle();
  EXPECT_EQ(axis.offset(), 40);
  axis.write(offset_output, 41);
  axis.cycle();
  EXPECT_EQ(axis.offset(), 40);
  EXPECT_EQ(axis.controlword(), quick_stop);
  EXPECT_THAT(axis.refusals(), ElementsAre(HasSubstr("(60B1:00) is outside its limits")));
}

TEST(LimitsOfSums, HoldEachPartAloneInAModeThatDoesNotAddThem) {
  SummingAxis axis{within_100, velocities, cyclic_position};
  axis.send(60, 60);
  EXPECT_EQ(axis.offset(), 60);
  axis.send(60, 101);
  EXPECT_EQ(axis.offset(), 60);
  EXPECT_THAT(axis.refusals(), ElementsAre(HasSubstr("(60B1:00) is outside its limits")));
  axis.send(60, 60);
  axis.send(101, 60);
  EXPECT_EQ(axis.target(), 60);
  EXPECT_THAT(axis.refusals(), ElementsAre(HasSubstr("(60FF:00) is outside its limits")));
}

TEST(LimitsOfSums, LetNoModeMakeASumValidThatIsOutside) {
  SummingAxis axis{within_100, velocities, cyclic_position};
  axis.send(60, 60);
  axis.set(mode_output, cyclic_velocity);
  axis.cycle();
  EXPECT_EQ(axis.controlword(), quick_stop);
  EXPECT_THAT(axis.refusals(), ElementsAre(HasSubstr(", which is outside its limits: velocity "
                                                     "0.12, limit 0.1")));
}

TEST(LimitsOfSums, LetNoModeMakeAnOffsetValidThatIsOutsideAlone) {
  SummingAxis axis{within_100, velocities, cyclic_velocity};
  axis.send(-100, 150);
  EXPECT_EQ(axis.offset(), 150);
  axis.go_to(cyclic_position);
  axis.send(0, 150);
  EXPECT_EQ(axis.controlword(), quick_stop);
  EXPECT_EQ(axis.refusals().size(), 1U);
}

TEST(LimitsOfSums, MeasureFromTheSumAfterTheModeThatAddsThem) {
  SummingAxis axis{{.rate = 10, .rate_of = LimitKind::acceleration}, velocities, cyclic_position};
  for (int i = 1; i <= 5; ++i) axis.send(0, 10 * i);
  axis.go_to(cyclic_velocity);
  axis.send(0, 50);
  axis.send(0, 60);
  EXPECT_EQ(axis.offset(), 60);
  EXPECT_THAT(axis.refusals(), IsEmpty());
  axis.send(6, 65);
  EXPECT_EQ(axis.offset(), 60);
  EXPECT_EQ(axis.refusals().size(), 1U);
}

TEST(LimitsOfSums, LetNoRandomCommandPutASumOutsideOntoTheWire) {
  std::mt19937 random{1};
  const auto below = [&random](unsigned n) { return static_cast<std::int64_t>(random() % n); };
  SummingAxis axis{within_100, velocities, cyclic_velocity};
  std::size_t refusals = 0;
  for (int i = 0; i < 20'000; ++i) {
    axis.feedback(0, enabled, cyclic_velocity);
    for (const SignalIndex output : {target_output, offset_output}) {
      if (below(3) == 0) continue;
      const std::int64_t value = below(160) - 80;
      below(2) == 0 ? axis.set(output, value) : axis.write(output, value);
    }
    if (below(2) == 0) axis.set(order_output, enable_operation);
    axis.cycle();
    ASSERT_LE(std::abs(axis.target() + axis.offset()), 100) << "cycle " << i;
    refusals += axis.refusals().size();
  }
  EXPECT_GT(refusals, 10U);
}

}  // namespace
}  // namespace takt::test
