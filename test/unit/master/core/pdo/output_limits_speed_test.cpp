// The set speed of an inverter, with the direction and the stop in its control word.
#include <cstring>
#include <gtest/gtest.h>

#include "test/unit/master/core/pdo/limited_axes.hpp"

namespace takt::test {
namespace {

constexpr std::int64_t run = 0x0001;
constexpr std::int64_t run_reverse = 0x0002;
constexpr std::int64_t stop = 0x0005;

/// The control word is the first output, the set speed the second one; without commands, the drive
/// stops.
void make_inverter(BusPlan& plan) {
  OutputLimit& limit = plan.limits.outputs[0];
  limit.quantity = AxisQuantity::velocity;
  limit.statusword.reset();
  limit.feedback.reset();
  limit.range = LimitKind::velocity;
  limit.rate_of = LimitKind::acceleration;
  limit.orders = SpeedOrders{.mask = 0x00FF,
                             .run = run,
                             .run_reverse = run_reverse,
                             .idle = {stop, stop, 6, 7},
                             .scale = 0.01};
  Signal& control = plan.layout.signals[*limit.controlword];
  control.fallback = Fallback::value;
  control.fallback_value = stop;
}

class SpeedLimits : public testing::Test {
 protected:
  void cycle(std::int64_t speed, std::int64_t control) {
    axis_.command(0, speed, control);
    axis_.cycle();
  }
  /// Brings the set speed to this value.
  void run_up(std::int64_t speed, std::int64_t control) {
    for (std::int64_t now = 0; now < speed; now += 2) cycle(now, control);
    cycle(speed, control);
  }

  /// 2 counts in a cycle of 2 ms are 10 Hz/s; 50 ms allow 50 counts at once.
  LimitedAxes axis_{1, {.low = -100, .high = 100, .rate = 2}, make_inverter};
};

TEST_F(SpeedLimits, HoldInBothDirections) {
  for (const std::int64_t direction : {run, run_reverse}) {
    run_up(100, direction);
    EXPECT_EQ(axis_.position(), 100);
    EXPECT_EQ(axis_.refusals(), 0U);
    cycle(105, direction);
    EXPECT_EQ(axis_.refusals(), 1U) << "above the velocity";
    EXPECT_EQ(axis_.controlword(), stop);
    cycle(0, stop);
  }
}

TEST_F(SpeedLimits, CountAChangeOfDirectionAsAChangeOfTheSpeed) {
  run_up(50, run);
  cycle(50, run_reverse);  // by 100 counts at once
  EXPECT_EQ(axis_.refusals(), 1U);
  EXPECT_EQ(axis_.controlword(), stop);
}

TEST_F(SpeedLimits, CountAChangeOfTheControlWordAlone) {
  run_up(50, run);
  axis_.set(0, run_reverse);
  axis_.cycle();
  EXPECT_EQ(axis_.refusals(), 1U);
  EXPECT_EQ(axis_.controlword(), stop);
}

TEST_F(SpeedLimits, LetADirectionChangeWhileTheSpeedIsLow) {
  run_up(5, run);
  cycle(5, run_reverse);
  EXPECT_EQ(axis_.refusals(), 0U);
  EXPECT_EQ(axis_.controlword(), run_reverse);
}

TEST_F(SpeedLimits, NeverRefuseAStop) {
  run_up(90, run);
  cycle(90, stop);
  EXPECT_EQ(axis_.refusals(), 0U);
  EXPECT_EQ(axis_.controlword(), stop);
  cycle(500, stop);
  EXPECT_EQ(axis_.refusals(), 0U) << "the drive does not follow it";
}

TEST_F(SpeedLimits, BeginAtStandstillAfterAStop) {
  run_up(90, run);
  cycle(90, stop);
  cycle(90, run);
  EXPECT_EQ(axis_.refusals(), 1U);
  cycle(10, run);
  EXPECT_EQ(axis_.controlword(), run);
}

TEST_F(SpeedLimits, HoldOnAverageForAProgramThatIsNotPunctual) {
  run_up(20, run);
  for (int i = 0; i < 10; ++i) axis_.cycle();
  cycle(40, run);  // at once what ten cycles allow
  cycle(42, run);
  cycle(46, run);  // the change of two cycles; 50 counts were left
  EXPECT_EQ(axis_.refusals(), 0U);
  std::int64_t speed = 46;
  for (int i = 0; i < 40 && axis_.controlword() == run; ++i) cycle(speed += 4, run);
  EXPECT_EQ(axis_.refusals(), 1U) << "twice the acceleration for long";
}

TEST_F(SpeedLimits, ReportTheSpeedInItsUnit) {
  cycle(60, run);
  const std::vector<Event> reported = axis_.reported();
  ASSERT_EQ(reported.size(), 1U);
  float measured = 0;
  std::memcpy(&measured, reported[0].bytes.data(), 4);
  EXPECT_FLOAT_EQ(measured, 12.0F) << "0.6 Hz in 50 ms";
}

}  // namespace
}  // namespace takt::test
