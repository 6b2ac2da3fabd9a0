#include "master/motion/trajectory.hpp"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "test/unit/master/motion/judge.hpp"
#include "test/unit/master/motion/random_tasks.hpp"

namespace takt::motion {
namespace {

constexpr Limits unit{.max_velocity = 1.0,
                      .min_velocity = -1.0,
                      .max_acceleration = 5.0,
                      .min_acceleration = -5.0,
                      .jerk = 50.0};

TEST(Trajectory, OfAllAxesArrivesAtOnceAndNotBeforeTheSlowest) {
  const std::array tasks{
      AxisTask{.from = {}, .to = {.position = 1.0}, .limits = unit},
      AxisTask{.from = {.velocity = 0.1}, .to = {.position = -0.5}, .limits = unit}};
  std::array<PlannedAxis, 2> planned;

  const auto duration = plan_trajectory(tasks, {}, planned);

  ASSERT_TRUE(duration.has_value());
  EXPECT_EQ(*duration, std::max(planned[0].shortest, planned[1].shortest));
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    EXPECT_NEAR(planned[i].profile.duration(), *duration, 1e-12);
    EXPECT_NEAR(planned[i].profile.end(tasks[i].from).position, tasks[i].to.position, 1e-12);
  }
}

TEST(Trajectory, WithoutSynchronisationTakesTheShortestTimeOfEachAxis) {
  const std::array tasks{AxisTask{.from = {}, .to = {.position = 1.0}, .limits = unit},
                         AxisTask{.from = {}, .to = {.position = 0.1}, .limits = unit}};
  std::array<PlannedAxis, 2> planned;

  const auto duration = plan_trajectory(tasks, {.synchronisation = Synchronisation::none}, planned);

  ASSERT_TRUE(duration.has_value());
  EXPECT_EQ(planned[0].duration, *duration);
  EXPECT_EQ(planned[1].duration, planned[1].shortest);
  EXPECT_LT(planned[1].duration, planned[0].duration);
}

TEST(Trajectory, LastsAtLeastTheMinimum) {
  const std::array tasks{AxisTask{.from = {}, .to = {.position = 0.1}, .limits = unit}};
  std::array<PlannedAxis, 1> planned;

  const auto duration = plan_trajectory(tasks, {.minimum_duration = 3.0}, planned);

  ASSERT_TRUE(duration.has_value());
  EXPECT_EQ(*duration, 3.0);
  EXPECT_NEAR(planned[0].profile.end({}).position, 0.1, 1e-12);
}

TEST(Trajectory, InPhaseIsAStraightLineWithinTheLimitsOfAllAxes) {
  Limits slow = unit;
  slow.max_velocity = 0.2;
  slow.min_acceleration = -1.0;
  const std::array tasks{
      AxisTask{.from = {}, .to = {.position = 1.0}, .limits = unit},
      AxisTask{.from = {.position = 2.0}, .to = {.position = 2.5}, .limits = slow},
      AxisTask{.from = {}, .to = {.position = -0.25}, .limits = slow}};
  std::array<PlannedAxis, 3> planned;

  const auto duration =
      plan_trajectory(tasks, {.synchronisation = Synchronisation::phase}, planned);

  ASSERT_TRUE(duration.has_value());
  for (int i = 0; i <= 100; ++i) {
    const double time = *duration * i / 100;
    const double first = planned[0].profile.at(tasks[0].from, time).position;
    EXPECT_NEAR(planned[1].profile.at(tasks[1].from, time).position, 2.0 + first / 2, 1e-12);
    EXPECT_NEAR(planned[2].profile.at(tasks[2].from, time).position, -first / 4, 1e-12);
  }
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    EXPECT_LE((Judge{tasks[i], planned[i].profile.segments()}).verdict().excess, 1e-9);
  }
}

TEST(Trajectory, ThatCannotBeAStraightLineArrivesAtOnceAllTheSame) {
  const std::array tasks{
      AxisTask{.from = {}, .to = {.position = 1.0}, .limits = unit},
      AxisTask{.from = {.velocity = -0.3}, .to = {.position = 1.0}, .limits = unit}};
  std::array<PlannedAxis, 2> planned;

  const auto duration =
      plan_trajectory(tasks, {.synchronisation = Synchronisation::phase}, planned);

  ASSERT_TRUE(duration.has_value());
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    EXPECT_NEAR(planned[i].profile.duration(), *duration, 1e-12);
    EXPECT_NEAR(planned[i].profile.end(tasks[i].from).position, 1.0, 1e-12);
  }
}

TEST(Trajectory, OfVelocitiesReachesThemAtOnce) {
  const std::array tasks{AxisTask{.from = {}, .to = {.velocity = 0.5}, .limits = unit},
                         AxisTask{.from = {}, .to = {.velocity = -0.1}, .limits = unit}};
  std::array<PlannedAxis, 2> planned;

  const auto duration = plan_trajectory(tasks, {.goal = Goal::velocity}, planned);

  ASSERT_TRUE(duration.has_value());
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    EXPECT_NEAR(planned[i].profile.duration(), *duration, 1e-12);
    EXPECT_NEAR(planned[i].profile.end({}).velocity, tasks[i].to.velocity, 1e-12);
    EXPECT_LE((Judge{{.from = {}, .to = planned[i].profile.end({}), .limits = unit},
                     planned[i].profile.segments()})
                  .verdict()
                  .excess,
              1e-9);
  }
}

TEST(Trajectory, OfSixRandomAxesArrivesAtOnce) {
  for (int which = 0; which < task_classes; ++which) {
    RandomTasks random{static_cast<std::uint64_t>(which)};
    for (int i = 0; i < 1'000; ++i) {
      std::vector<AxisTask> tasks;
      for (int axis = 0; axis < 6; ++axis)
        tasks.push_back(random.next(static_cast<TaskClass>(which)));
      std::array<PlannedAxis, 6> planned;

      const auto duration = plan_trajectory(tasks, {}, planned);

      ASSERT_TRUE(duration.has_value());
      if (*duration > 1e4) continue;  // a start far outside its limits
      for (std::size_t axis = 0; axis < tasks.size(); ++axis) {
        const Judge judge{tasks[axis], planned[axis].profile.segments()};
        ASSERT_NEAR(planned[axis].profile.duration(), *duration, 1e-9 * (1.0 + *duration));
        ASSERT_LE(judge.verdict().end_error, 1e-8) << which << ' ' << i << ' ' << axis;
        ASSERT_LE(judge.verdict().excess, 1e-9) << which << ' ' << i << ' ' << axis;
      }
    }
  }
}

TEST(Trajectory, StaysInsideTheRangeOfPositionsOnItsWholeWay) {
  // The axis moves towards its limit and needs a distance of 0.1 to 0.3 to stop.
  AxisTask task{.from = {.position = 0.0, .velocity = 1.0}, .to = {}, .limits = unit};
  std::array<PlannedAxis, 1> planned;
  const auto plan = [&](double limit) {
    task.range = {.min = -1.0, .max = limit};
    return plan_trajectory(std::span{&task, 1}, {}, planned);
  };
  ASSERT_TRUE(plan(1.0).has_value());
  const double turn = positions_of(planned[0].profile, task.from).max;
  EXPECT_GT(turn, 0.1);
  EXPECT_LT(turn, 0.3);

  EXPECT_TRUE(plan(turn).has_value());

  const auto refused = plan(turn * 0.99);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().defect, Defect::position_range);
}

TEST(Trajectory, ComesBackFromOutsideTheRangeOfPositions) {
  const std::array tasks{AxisTask{.from = {.position = 2.0},
                                  .to = {.position = 0.5},
                                  .limits = unit,
                                  .range = {.min = 0.0, .max = 1.0}}};
  std::array<PlannedAxis, 1> planned;

  EXPECT_TRUE(plan_trajectory(tasks, {}, planned).has_value());
}

TEST(Trajectory, OnALineKeepsTheRangesOfAllAxes) {
  AxisTask first{.from = {}, .to = {.position = 1.0, .velocity = -0.5}, .limits = unit};
  AxisTask second{.from = {}, .to = {.position = -2.0, .velocity = 1.0}, .limits = unit};
  std::array<PlannedAxis, 2> planned;
  const auto plan = [&](double least) {
    second.range.min = least;
    const std::array tasks{first, second};
    return plan_trajectory(tasks, {.synchronisation = Synchronisation::phase}, planned);
  };
  ASSERT_TRUE(plan(-10.0).has_value());
  const double turn = positions_of(planned[1].profile, {}).min;
  EXPECT_LT(turn, -2.0);
  EXPECT_TRUE(plan(turn).has_value());
  EXPECT_FALSE(plan(-2.0001).has_value());
}

TEST(Trajectory, MayGetANewTargetInEachCycleFromItsOwnState) {
  RandomTasks random{7};
  AxisTask task = random.next(TaskClass::rest_to_rest);
  const Limits limits = task.limits;
  State state = task.from;
  for (int i = 0; i < 20'000; ++i) {
    if (i % 10 == 0) task.to.position = random.next(TaskClass::general).to.position / 10;
    std::array<PlannedAxis, 1> planned;
    const std::array tasks{AxisTask{.from = state, .to = task.to, .limits = limits}};
    ASSERT_TRUE(plan_trajectory(tasks, {}, planned).has_value());
    state = planned[0].profile.at(state, 0.004);
    ASSERT_LE(std::abs(state.velocity),
              std::max(limits.max_velocity, -limits.min_velocity) * (1 + 1e-9));
  }
}

TEST(Trajectory, IsRefusedWithTheAxisAndTheReason) {
  const auto defect = [](AxisTask task) {
    const std::array tasks{AxisTask{.from = {}, .to = {}, .limits = unit}, task};
    std::array<PlannedAxis, 2> planned;
    const auto duration = plan_trajectory(tasks, {}, planned);
    EXPECT_FALSE(duration.has_value());
    EXPECT_EQ(duration.error().axis, 1u);
    return duration.error().defect;
  };
  const AxisTask good{.from = {}, .to = {.position = 1.0}, .limits = unit};
  AxisTask task = good;
  task.from.velocity = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(defect(task), Defect::not_finite);
  task = good;
  task.limits.min_velocity = 0.0;
  EXPECT_EQ(defect(task), Defect::velocity_limits);
  task = good;
  task.limits.max_acceleration = -1.0;
  EXPECT_EQ(defect(task), Defect::acceleration_limits);
  task = good;
  task.limits.jerk = 0.0;
  EXPECT_EQ(defect(task), Defect::jerk_limit);
  task = good;
  task.to.velocity = 1.1;
  EXPECT_EQ(defect(task), Defect::target_velocity);
  task = good;
  task.to.acceleration = -5.1;
  EXPECT_EQ(defect(task), Defect::target_acceleration);
  task = good;
  task.to = {.position = 1.0, .velocity = 0.9, .acceleration = -5.0};
  EXPECT_EQ(defect(task), Defect::velocity_before_target);
}

TEST(Trajectory, EndsAtItsTargetAlsoWithLimitsThatAreFarApart) {
  const AxisTask task{.from = {.position = 6.2552561058050875e-09},
                      .to = {.position = -3.6551741658825909e-07},
                      .limits = {.max_velocity = 4.22991e+07,
                                 .min_velocity = -4.22991e+07,
                                 .max_acceleration = 1.85281e-08,
                                 .min_acceleration = -1.85281e-08,
                                 .jerk = 7.53909e+07}};
  std::array<PlannedAxis, 1> planned;

  ASSERT_TRUE(plan_trajectory(std::span{&task, 1}, {}, planned).has_value());

  EXPECT_NEAR(planned[0].profile.end(task.from).position, task.to.position, 1e-15);
}

/// Where numbers have too few digits for a motion, the planner says so.
TEST(Trajectory, OfLimitsThatDifferByManyPowersOfTenIsPreciseOrRefused) {
  RandomTasks random{1};
  int refused = 0;
  for (int i = 0; i < 50'000; ++i) {
    const AxisTask task = random.next(TaskClass::wide_limits);
    std::array<PlannedAxis, 1> planned;
    const auto duration = plan_trajectory(std::span{&task, 1}, {}, planned);
    if (!duration) {
      ASSERT_EQ(duration.error().defect, Defect::precision) << i;
      ++refused;
      continue;
    }
    const Judge judge{task, planned[0].profile.segments()};
    const double growth = std::max(*duration / 1e7, 1.0);
    ASSERT_LE(judge.verdict().end_error, 1.001e-8 * growth) << i;
    ASSERT_LE(judge.verdict().excess, 1.001e-9 * growth) << i;
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, 5'000);
}

/// Numbers whose products overflow must not make the planner search for ever.
TEST(Trajectory, LimitsThatCannotBeComputedWithAreRefused) {
  const auto limits = [](double velocity, double acceleration, double jerk) {
    return Limits{.max_velocity = velocity,
                  .min_velocity = -velocity,
                  .max_acceleration = acceleration,
                  .min_acceleration = -acceleration,
                  .jerk = jerk};
  };
  for (const Limits& extreme :
       {limits(7.3e-129, 1.4e81, 4.7e-247), limits(1e-50, 2.6e-293, 4.9e187)}) {
    const std::array tasks{AxisTask{.from = {},
                                    .to = {.position = -85.115},
                                    .limits = extreme,
                                    .range = {.min = -100.0, .max = 100.0}}};
    std::array<PlannedAxis, 1> planned;
    EXPECT_FALSE(plan_trajectory(tasks, {}, planned).has_value());
  }
}

}  // namespace
}  // namespace takt::motion
