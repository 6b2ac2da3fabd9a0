// Rotary axes, whose position begins again after a turn.
#include <cmath>
#include <random>

#include "master/motion/beat/axis_motions.hpp"
#include "master/motion/planner/motion_planner.hpp"
#include "test/unit/master/rt/motion/driven_axis_bench.hpp"

namespace takt {
namespace {

using motion::AxisState;
using test::Bench;

constexpr double scale = 0.01;  // rad
constexpr double period = 0.002;
constexpr motion::Limits limits{.max_velocity = 60.0,
                                .min_velocity = -60.0,
                                .max_acceleration = 3000.0,
                                .min_acceleration = -3000.0,
                                .jerk = 200'000.0};

BusPlan wheel_plan(const Turn& turn) {
  BusPlan plan = test::one_axis();
  plan.limits.outputs.push_back({.signal = 3,
                                 .rate = limits.max_velocity * period / scale,
                                 .bend = limits.max_acceleration * period * period / scale,
                                 .modulus = turn.length,
                                 .lowest = turn.lowest,
                                 .wraps = true,
                                 .quantity = AxisQuantity::position,
                                 .controlword = 2,
                                 .feedback = 1,
                                 .statusword = 0});
  return plan;
}

/// A rotary axis whose drive follows at once, with its motions and their planner.
class Wheel {
 public:
  Wheel(const Turn& made, std::int64_t start)
      : turn{made}, bench{wheel_plan(made)}, drive{start}, motions{1, period}, planner{1, period} {
    beat(0x0023);
    beat(0x0023);
    beat(0x1027);
  }

  void beat(std::uint16_t statusword = 0x1027) {
    bench.hear(statusword, static_cast<std::int32_t>(drive));
    const std::array inputs{bench.axis.read(bench.pdos, true, motions.reports()[0])};
    const motion::AxisReport& report = motions.run(bench.cycle, inputs)[0];
    EXPECT_TRUE(bench.axis.write(bench.pdos.outputs(), report, {.cycle = bench.cycle, .now = {}}));
    bench.pack();
    planner.observe(bench.cycle, motions.reports());
    const std::int64_t target = bench.target();
    EXPECT_EQ(turn.inside(static_cast<double>(target)), static_cast<double>(target));
    step = turn.nearest(static_cast<double>(target - drive), 0.0);
    drive = target;
    way += step;
    EXPECT_LE(std::abs(report.following_error), limits.max_velocity * period * 1.01 + scale);
  }
  void beats(int count) {
    for (int i = 0; i < count; ++i) beat();
  }
  void command(motion::Goal goal, const motion::State& to) {
    const motion::AxisGoal axis{
        .to = to, .limits = limits, .turn = turn.in_unit(scale, 0.0).length};
    const auto orders =
        planner.plan({.goal = goal, .timeout = 1'000'000}, std::array{axis}, bench.cycle + 3);
    ASSERT_TRUE(orders.has_value());
    motions.sender_heard(0, bench.cycle);
    motions.renew_jog(0, {0, bench.cycle});
    ASSERT_EQ(motions.take(orders->front()), motion::Outcome::none);
    way = 0.0;
  }
  const motion::AxisReport& report() const { return motions.reports()[0]; }

  Turn turn;
  Bench bench;
  std::int64_t drive;
  motion::AxisMotions motions;
  motion::MotionPlanner planner;
  double step = 0.0;  ///< of the target position in the last beat, in counts
  double way = 0.0;   ///< since the last command
};

/// Turns of the drive: one that begins at 0, one that begins below 0, and the whole counter.
constexpr std::array turns{Turn{.length = 628.0, .lowest = 0.0},
                           Turn{.length = 3600.0, .lowest = -1800.0},
                           Turn{.length = 0x1p32, .lowest = -0x1p31}};

TEST(DrivenAxisTurn, AMoveTakesTheShortestWayOverTheEndOfTheTurn) {
  std::mt19937 random{7};
  std::uniform_int_distribution<std::int64_t> near{-300, 300};
  for (const Turn& turn : turns) {
    for (int i = 0; i < 40; ++i) {
      const auto place = [&] {
        return static_cast<std::int64_t>(
            turn.inside(turn.lowest + static_cast<double>(near(random))));
      };
      const std::int64_t start = place();
      const std::int64_t target = place();
      Wheel wheel{turn, start};
      wheel.command(motion::Goal::position, {.position = static_cast<double>(target) * scale});
      wheel.beats(400);
      EXPECT_EQ(wheel.report().state, AxisState::standing);
      EXPECT_EQ(wheel.drive, target) << "from " << start;
      EXPECT_EQ(wheel.way, turn.nearest(static_cast<double>(target - start), 0.0));
    }
  }
}

TEST(DrivenAxisTurn, HalfATurnGoesUp) {
  for (const std::int64_t start : {0, 100, 314, 500}) {
    Wheel wheel{turns[0], start};
    const double target = turns[0].inside(static_cast<double>(start + 314));
    wheel.command(motion::Goal::position, {.position = target * scale});
    wheel.beats(400);
    EXPECT_EQ(wheel.way, 314.0) << start;
  }
}

/// Each step is that of its velocity, rounded to counts, however many turns lie behind.
TEST(DrivenAxisTurn, AJogGoesOnOverEachEndOfTheTurn) {
  for (const Turn& turn : turns) {
    for (const double velocity : {-47.3, 52.9}) {
      const double end = velocity > 0.0 ? turn.lowest + turn.length - 2000.0 : turn.lowest + 2000.0;
      Wheel wheel{turn, static_cast<std::int64_t>(turn.inside(end))};
      wheel.command(motion::Goal::velocity, {.velocity = velocity});
      wheel.beats(100);
      for (int i = 0; i < 20'000; ++i) {
        wheel.beat();
        ASSERT_NEAR(wheel.step, velocity * period / scale, 1.0) << i;
      }
      wheel.motions.stop_axis(0, motion::StopCause::application);
      wheel.beats(300);
      EXPECT_EQ(wheel.report().state, AxisState::standing);
      EXPECT_EQ(wheel.report().stop.cause, motion::StopCause::application);
    }
  }
}

/// The positions of a drive that is switched on again are inside the turn, and the way of a move is
/// still the shortest one.
TEST(DrivenAxisTurn, AfterManyTurnsTheNextMoveIsAShortOne) {
  Wheel wheel{turns[0], 0};
  wheel.command(motion::Goal::velocity, {.velocity = 50.0});
  wheel.beats(1000);
  wheel.motions.stop_axis(0, motion::StopCause::application);
  wheel.beats(300);
  ASSERT_GT(wheel.report().commanded.position, 50.0);
  wheel.command(motion::Goal::position, {.position = 3.0});
  wheel.beats(400);
  EXPECT_EQ(wheel.drive, 300);
  EXPECT_LE(std::abs(wheel.way), 314.0);
  wheel.beat(0x0023);
  wheel.beat(0x1027);
  EXPECT_NEAR(wheel.report().commanded.position, 3.0, 1e-9);
  EXPECT_NEAR(wheel.report().following_error, 0.0, 1e-9);
}

/// The application has left its set-point at one end of the turn, and the drive is at the other
/// one.
TEST(DrivenAxisTurn, TheFollowingErrorIsTheShortestWay) {
  Wheel wheel{turns[0], 627};
  wheel.drive = 2;
  wheel.bench.hear(0x1027, 2);
  const motion::AxisInput input = wheel.bench.axis.read(wheel.bench.pdos, true, wheel.report());
  EXPECT_NEAR(input.actual.position - wheel.report().commanded.position, 0.03, 1e-9);
}

TEST(DrivenAxisTurn, OnlyAnAxisWhoseRangeIsAWholeTurnIsRotary) {
  BusPlan plan = wheel_plan(turns[0]);
  EXPECT_EQ(motion_axes(plan).at(0).turn.length, 628.0);
  plan.limits.outputs[0].low = 0.0;
  plan.limits.outputs[0].high = 627.0;
  EXPECT_EQ(motion_axes(plan).at(0).turn.length, 628.0);
  plan.limits.outputs[0].high = 626.0;
  EXPECT_EQ(motion_axes(plan).at(0).turn.length, 0.0);
  plan.limits.outputs[0].high = OutputLimit::none;
  plan.limits.outputs[0].modulus = 627.7;
  EXPECT_EQ(motion_axes(plan).at(0).turn.length, 628.0);
  plan.limits.outputs[0].modulus = 0.0;
  EXPECT_EQ(motion_axes(plan).at(0).turn.length, 0.0);
}

}  // namespace
}  // namespace takt
