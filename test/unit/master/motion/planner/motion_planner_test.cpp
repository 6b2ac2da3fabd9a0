#include "master/motion/planner/motion_planner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "master/motion/beat/axis_motions.hpp"

namespace takt::motion {
namespace {

constexpr double period = 0.001;
constexpr Limits limits{.max_velocity = 1.0,
                        .min_velocity = -0.5,
                        .max_acceleration = 5.0,
                        .min_acceleration = -4.0,
                        .jerk = 50.0};

/// A planner and the bus thread, whose axes follow at once.
class Line {
 public:
  explicit Line(std::size_t axes) : planner{axes, period}, motions{axes, period}, inputs(axes) {
    for (AxisInput& input : inputs) input.condition = AxisCondition::enabled;
    step();
  }

  void step() {
    ++cycle;
    motions.run(cycle, inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      for (const EndedOrder& end : motions.reports()[i].ended.orders()) ends.push_back(end);
      inputs[i].actual = motions.reports()[i].commanded;
    }
    planner.observe(cycle, motions.reports());
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  auto plan(const std::vector<AxisGoal>& goals, Goal goal = Goal::position) {
    return planner.plan({.goal = goal, .timeout = 100'000}, goals, cycle + 3);
  }
  /// Plans, and gives the orders to the bus thread.
  bool send(const std::vector<AxisGoal>& goals, Goal goal = Goal::position) {
    const auto orders = plan(goals, goal);
    if (!orders) return false;
    for (const MotionOrder& order : *orders) {
      motions.renew_jog(order.axis, {order.sender, cycle});
      EXPECT_EQ(motions.take(order), Outcome::none);
    }
    return true;
  }
  const AxisReport& axis(std::size_t i) const { return motions.reports()[i]; }

  MotionPlanner planner;
  AxisMotions motions;
  std::vector<AxisInput> inputs;
  std::vector<EndedOrder> ends;
  CycleNumber cycle = 0;
};

AxisGoal to(std::uint8_t axis, double position) {
  return {.axis = axis, .to = {.position = position}, .limits = limits};
}

TEST(MotionPlanner, ANewTargetAtAnyTimeTakesOverWithoutAJump) {
  Line line{1};
  std::mt19937_64 random{5};
  State before = line.axis(0).commanded;
  for (int i = 0; i < 20'000; ++i) {
    if (random() % 20 == 0) {
      line.send({to(0, std::uniform_real_distribution<double>{-2.0, 2.0}(random))});
    }
    line.step();
    const State& now = line.axis(0).commanded;
    const State free = advanced(before, period, 0.0);
    ASSERT_LE(std::abs(now.velocity - free.velocity), limits.jerk * period * period);
    ASSERT_LE(std::abs(now.position - free.position), limits.jerk * period * period * period);
    before = now;
  }
  std::size_t replaced = 0;
  for (const EndedOrder& end : line.ends) {
    EXPECT_TRUE(end.outcome == Outcome::replaced || end.outcome == Outcome::done)
        << static_cast<int>(end.outcome);
    replaced += end.outcome == Outcome::replaced;
  }
  EXPECT_GT(replaced, 300U);
}

/// With a jerk of 1, the velocity would rise by 5^2 / 2 until the acceleration has ended.
TEST(MotionPlanner, ANewTargetWithALowJerkDoesNotMakeTheAxisFasterThanBothAllow) {
  for (const bool stops : {false, true}) {
    Line line{1};
    ASSERT_TRUE(line.send({to(0, 3.0)}));
    while (line.axis(0).commanded.acceleration < limits.max_acceleration) line.step();
    AxisGoal gentle = to(0, 2.5);
    gentle.limits.max_velocity = 0.5;
    gentle.limits.jerk = 1.0;
    ASSERT_TRUE(line.send({gentle}));
    double fastest = 0.0;
    for (int i = 0; i < 20'000; ++i) {
      if (stops && i == 8) line.motions.stop_axis(0, StopCause::application);
      line.step();
      fastest = std::max(fastest, line.axis(0).commanded.velocity);
    }
    EXPECT_LE(fastest, limits.max_velocity + 1e-9) << stops;
    EXPECT_EQ(line.axis(0).commanded.velocity, 0.0) << stops;
    EXPECT_EQ(std::abs(line.axis(0).commanded.position - 2.5) < 1e-9, !stops);
  }
}

TEST(MotionPlanner, AxesOfAGroupArriveTogether) {
  Line line{3};
  ASSERT_TRUE(line.send({to(0, 1.0), to(1, -0.1), to(2, 0.3)}));
  line.steps(3);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(line.axis(i).state, AxisState::moving);
  const CycleNumber left = line.axis(0).cycles_left;
  line.steps(static_cast<int>(left) - 1);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(line.axis(i).state, AxisState::moving) << i;
  line.steps(2);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(line.axis(i).state, AxisState::standing) << i;
}

TEST(MotionPlanner, AJogStopsInsideTheRange) {
  Line line{1};
  AxisGoal jog{
      .axis = 0, .to = {.velocity = 0.8}, .limits = limits, .range = {.min = -1.0, .max = 2.0}};
  ASSERT_TRUE(line.send({jog}, Goal::velocity));
  line.steps(1000);
  EXPECT_NEAR(line.axis(0).commanded.velocity, 0.8, 1e-12);
  line.steps(4000);
  EXPECT_EQ(line.axis(0).state, AxisState::standing);
  EXPECT_LE(line.axis(0).commanded.position, 2.0 + 1e-8);
  EXPECT_GE(line.axis(0).commanded.position, 2.0 - 0.8 * period);
  jog.range.max = 1.9;
  EXPECT_EQ(line.plan({jog}, Goal::velocity).error().fault, PlanFault::impossible)
      << "the axis is outside already";
}

TEST(MotionPlanner, RefusesWithTheReasonAndTheAxis) {
  MotionPlanner early{1, period};
  EXPECT_EQ(early.plan({}, std::vector{to(0, 1.0)}, 10).error().fault, PlanFault::no_report);
  Line line{2};
  EXPECT_EQ(line.plan({to(2, 1.0)}).error().fault, PlanFault::no_axis);
  EXPECT_EQ(line.plan({to(1, 1.0), to(1, 2.0)}).error().fault, PlanFault::no_axis);
  AxisGoal outside = to(1, 1.0);
  outside.range = {.min = -0.5, .max = 0.5};
  const PlanRefusal refusal = line.plan({to(0, 1.0), outside}).error();
  EXPECT_EQ(refusal.fault, PlanFault::impossible);
  EXPECT_EQ(refusal.axis, 1);
  EXPECT_EQ(refusal.defect, Defect::position_range);
  AxisGoal slow{.axis = 0, .to = {.velocity = 1.0}, .limits = limits};
  slow.limits.max_acceleration = 1e-3;
  EXPECT_EQ(line.plan({slow}, Goal::velocity).error().fault, PlanFault::too_long);
  line.inputs[0].condition = AxisCondition::disabled;
  line.step();
  EXPECT_EQ(line.plan({to(0, 1.0)}).error().fault, PlanFault::not_enabled);
}

TEST(MotionPlanner, AWaitingOrderIsReplacedOrAwaited) {
  Line line{1};
  ASSERT_TRUE(line.send({to(0, 1.0)}));
  line.step();
  ASSERT_TRUE(line.send({to(0, -0.3)}));
  EXPECT_EQ(line.plan({to(0, 0.5)})->front().begin, line.cycle + 2) << "that of the waiting order";
  line.step();
  EXPECT_EQ(line.plan({to(0, 1.0)}).error().fault, PlanFault::busy);
  line.steps(5000);
  EXPECT_NEAR(line.axis(0).commanded.position, -0.3, 1e-12);
}

/// The bus thread takes one order of an axis in a cycle, and the planner does not know which.
TEST(MotionPlanner, ForgetsNoOrderThatMayBegin) {
  Line line{1};
  std::vector<MotionOrder> orders;
  PlanFault fault{};
  for (int i = 0; i < 20; ++i) {
    const auto planned = line.plan({to(0, 0.1 * i + 1.0)});
    if (planned) {
      orders.push_back(planned->front());
    } else {
      fault = planned.error().fault;
    }
  }
  EXPECT_EQ(fault, PlanFault::busy);
  ASSERT_GE(orders.size(), 2U);
  ASSERT_EQ(line.motions.take(orders.front()), Outcome::none);
  EXPECT_EQ(line.motions.take(orders.back()), Outcome::second_in_cycle);
  line.steps(4);
  ASSERT_EQ(line.axis(0).running, orders.front().id);
  EXPECT_NE(line.planner.order(0, orders.front().id), nullptr);
  EXPECT_TRUE(line.send({to(0, 0.5)})) << "the others are over";
  line.steps(5000);
  EXPECT_NEAR(line.axis(0).commanded.position, 0.5, 1e-12);
}

TEST(MotionPlanner, AStoppingAxisIsRefused) {
  Line line{1};
  ASSERT_TRUE(line.send({to(0, 1.0)}));
  line.steps(300);
  line.motions.stop_axis(0, StopCause::application);
  line.step();
  EXPECT_EQ(line.plan({to(0, 0.0)}).error().fault, PlanFault::stopping);
}

/// The axis was moved by hand, or its range was changed.
TEST(MotionPlanner, AJogBringsAnAxisBackIntoItsRangeButNotFartherOut) {
  Line line{1};
  AxisGoal jog{
      .axis = 0, .to = {.velocity = -0.2}, .limits = limits, .range = {.min = 0.5, .max = 2.0}};
  const auto refused = line.plan({jog}, Goal::velocity);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().defect, Defect::position_range);
  jog.to.velocity = 0.2;
  ASSERT_TRUE(line.send({jog}, Goal::velocity));
  line.steps(20'000);
  EXPECT_EQ(line.axis(0).state, AxisState::standing);
  EXPECT_LE(line.axis(0).commanded.position, 2.0);
  EXPECT_NEAR(line.axis(0).commanded.position, 2.0, 1e-3);
}

}  // namespace
}  // namespace takt::motion
