#pragma once
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "master/motion/beat/axis_motions.hpp"
#include "master/motion/trajectory.hpp"

namespace takt::motion::test {

/// Axes whose drives follow at once. The plant checks each beat.
class Plant {
 public:
  static constexpr double period = 0.001;
  static constexpr Limits limits{.max_velocity = 1.0,
                                 .min_velocity = -0.5,
                                 .max_acceleration = 5.0,
                                 .min_acceleration = -4.0,
                                 .jerk = 50.0};

  static Profile plan(const State& from, const State& to, Goal goal = Goal::position) {
    const std::array tasks{AxisTask{.from = from, .to = to, .limits = limits}};
    std::array<PlannedAxis, 1> planned;
    EXPECT_TRUE(plan_trajectory(tasks, {.goal = goal}, planned).has_value());
    return planned[0].profile;
  }

  explicit Plant(std::size_t axes) : motions{axes, period}, inputs(axes), last(axes), ended(axes) {
    for (AxisInput& input : inputs) input.condition = AxisCondition::enabled;
  }

  void step() {
    ++cycle;
    const auto reports = motions.run(cycle, inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const bool powered =
          last[i].state != AxisState::unpowered && reports[i].state != AxisState::unpowered;
      const bool waits = inputs[i].is_unsent;
      if (powered && !waits && !inputs[i].set_point) judge(last[i].commanded, reports[i].commanded);
      last[i] = reports[i];
      for (const EndedOrder& order : reports[i].ended.orders()) ended[i] = order;
      if (follows) inputs[i].actual = reports[i].commanded;
    }
  }

  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }

  MotionOrder order(std::uint8_t axis, const State& to, CycleNumber ahead = 10) const {
    const State& from = last[axis].commanded;
    return {.id = ids,
            .axis = axis,
            .group = axis,
            .begin = cycle + ahead,
            .from = from,
            .profile = plan(from, to),
            .stop = limits,
            .timeout = 500};
  }

  /// Takes the order and a sign of life of its sender.
  bool take(const MotionOrder& order) {
    motions.sender_heard(order.sender, cycle);
    motions.renew_jog(order.axis, {order.sender, cycle});
    return motions.take(order) == Outcome::none;
  }

  /// Starts motions of three axes, of which the last is in a group of its own.
  void start_groups() {
    step();
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
      MotionOrder made = order(axis, {.position = 1.0 + axis}, 1);
      made.group = axis == 2 ? 2 : 0;
      made.axes = axis == 2 ? 1 : 2;
      made.timeout = 100000;
      made.max_following_error = 0.1;
      ASSERT_TRUE(take(made));
    }
    steps(300);
  }

  AxisMotions motions;
  std::vector<AxisInput> inputs;
  std::vector<AxisReport> last;
  std::vector<EndedOrder> ended;  ///< of each axis, the order that ended last
  CycleNumber cycle = 0;
  std::uint32_t ids = 1;
  bool follows = true;

 private:
  /// Expects no jump: the change in one beat keeps the limit of the jerk, and all limits hold.
  static void judge(const State& before, const State& now) {
    constexpr double tolerance = 1e-9;
    ASSERT_LE(now.velocity, limits.max_velocity + tolerance);
    ASSERT_GE(now.velocity, limits.min_velocity - tolerance);
    ASSERT_LE(now.acceleration, limits.max_acceleration + tolerance);
    ASSERT_GE(now.acceleration, limits.min_acceleration - tolerance);
    ASSERT_LE(std::abs(now.acceleration - before.acceleration), limits.jerk * period + tolerance);
    const State free = advanced(before, period, 0.0);
    ASSERT_LE(std::abs(now.velocity - free.velocity),
              limits.jerk * period * period / 2 + tolerance);
    ASSERT_LE(std::abs(now.position - free.position),
              limits.jerk * period * period * period / 6 + tolerance);
  }
};

}  // namespace takt::motion::test
