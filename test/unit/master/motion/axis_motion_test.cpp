#include "master/motion/axis_motion.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "test/unit/master/motion/judge.hpp"
#include "test/unit/master/motion/random_tasks.hpp"

namespace takt::motion {
namespace {

constexpr Limits unit{.max_velocity = 1.0,
                      .min_velocity = -1.0,
                      .max_acceleration = 1.0,
                      .min_acceleration = -1.0,
                      .jerk = 1.0};

double shortest(const State& from, const State& to, const Limits& limits = unit) {
  return AxisMotion{from, to, limits, Goal::position}.possible(0.0);
}

TEST(AxisMotion, OfAShortWayHasNoHoldAndLastsTheFourthPartFourTimes) {
  // With jerk only, a way of 2 j t^3 takes 4 t.
  EXPECT_NEAR(shortest({}, {.position = 2 * 0.125}), 4 * 0.5, 1e-12);
}

TEST(AxisMotion, OfALongWayReachesBothLimits) {
  // Each of the two ramps takes 1 s + 1 s and covers 1 m. The other 3 m take 3 s at 1 m/s.
  EXPECT_NEAR(shortest({}, {.position = 5.0}), 4.0 + 3.0, 1e-12);
}

TEST(AxisMotion, WithOtherLimitsForEachDirectionUsesThem) {
  const Limits limits{.max_velocity = 4.0,
                      .min_velocity = -1.0,
                      .max_acceleration = 8.0,
                      .min_acceleration = -2.0,
                      .jerk = 1e9};  // jerk takes nearly no time
  EXPECT_NEAR(shortest({}, {.position = 100.0}, limits), 25.0 + 0.25 + 1.0, 1e-6);
  EXPECT_NEAR(shortest({}, {.position = -100.0}, limits), 100.0 + 0.25 + 0.0625, 1e-6);
}

TEST(AxisMotion, FromTheTargetToTheTargetTakesNoTime) {
  const State state{.position = 1.0, .velocity = 0.5, .acceleration = -0.25};
  const AxisMotion motion{state, state, unit, Goal::position};

  EXPECT_EQ(motion.possible(0.0), 0.0);
  EXPECT_TRUE(motion.profile(0.0).segments().empty());
}

TEST(AxisMotion, AfterItsTargetGoesBack) {
  const State from{.position = 0.0, .velocity = 1.0};
  const AxisMotion motion{from, {}, unit, Goal::position};
  const double duration = motion.possible(0.0);

  const State end = motion.profile(duration).end(from);

  EXPECT_GT(duration, 4.0);
  EXPECT_NEAR(end.position, 0.0, 1e-12);
  EXPECT_NEAR(end.velocity, 0.0, 1e-12);
}

TEST(AxisMotion, ToAVelocityEndsWhereverThatIs) {
  const State from{.position = 3.0};
  const AxisMotion motion{from, {.velocity = 0.25}, unit, Goal::velocity};
  const double duration = motion.possible(0.0);

  EXPECT_NEAR(duration, 1.0, 1e-12);  // 0.5 s up to 0.5 m/s^2, 0.5 s down
  EXPECT_NEAR(motion.profile(duration).end(from).velocity, 0.25, 1e-12);
}

TEST(AxisMotion, HasDurationsThatAreImpossibleBetweenPossibleOnes) {
  // The axis is 1 m before its target and leaves it with the speed with which it comes. It arrives
  // after 1 s, or after it has gone back.
  const State from{.position = -1.0, .velocity = 1.0};
  const State to{.position = 0.0, .velocity = 1.0};
  const AxisMotion motion{from, to, unit, Goal::position};
  EXPECT_NEAR(motion.possible(0.0), 1.0, 1e-12);

  const double later = motion.possible(2.5);

  EXPECT_GE(later, 2.5);
  EXPECT_NEAR(motion.profile(later).end(from).position, 0.0, 1e-9);
}

TEST(AxisMotion, ThatPassesItsTargetAndReturnsToItStopsWhenItIsThereFirst) {
  // The motion that goes down farthest is beyond the target in the middle of a range of durations,
  // and exactly at the target at its end, after 2 s.
  const Limits limits{.max_velocity = 4.0,
                      .min_velocity = -4.0,
                      .max_acceleration = 5.0,
                      .min_acceleration = -1.0,
                      .jerk = 1.0};
  const State from{.position = -0.5, .velocity = -2.5, .acceleration = 2.5};
  const State to{.position = -1.5, .velocity = 1.5, .acceleration = 2.5};

  EXPECT_NEAR(shortest(from, to, limits), 1.7419270827943674, 1e-12);
}

TEST(AxisMotion, ReachesATargetThatOnlyTheLastDurationOfARangeReaches) {
  const Limits limits{.max_velocity = 8.0,
                      .min_velocity = -8.0,
                      .max_acceleration = 1.0,
                      .min_acceleration = -5.0,
                      .jerk = 1.0};
  const State from{.position = 0.5, .velocity = 1.0, .acceleration = -2.0};
  const State to{.position = -0.5, .velocity = -2.0, .acceleration = -2.0};

  EXPECT_NEAR(shortest(from, to, limits), 2.0, 1e-12);
}

TEST(AxisMotion, FromRestToATargetCloseByMovesAlsoFarFromTheOrigin) {
  const State from{.position = 1e6};
  const State to{.position = 1e6 + 0.001953125};
  const AxisMotion motion{from, to, unit, Goal::position};

  const Profile profile = motion.profile(motion.possible(0.0));

  EXPECT_NEAR(profile.duration(), 4 * std::cbrt(0.001953125 / 2), 1e-12);
  EXPECT_NEAR(profile.end(from).position, to.position, 1e-9);
}

TEST(AxisMotion, ThatHasMoreThanADayForAShortWayEndsAtItsTarget) {
  // A small acceleration that remains before the cruise would become a distance.
  const State from{.acceleration = 1e-10};
  const State to{.position = 1e-9};
  const AxisMotion motion{from, to, unit, Goal::position};

  const Profile profile = motion.profile(motion.possible(1e5));

  const AxisTask task{.from = from, .to = to, .limits = unit};
  EXPECT_LE((Judge{task, profile.segments()}).verdict().end_error, 1e-8);
}

TEST(AxisMotion, WithMoreTimeThanItNeedsCruisesSlowly) {
  const State from{};
  const AxisMotion motion{from, {.position = 1.0}, unit, Goal::position};

  const Profile profile = motion.profile(20.0);

  double fastest = 0.0;
  for (double time = 0.0; time < 20.0; time += 0.01) {
    fastest = std::max(fastest, profile.at(from, time).velocity);
    EXPECT_GT(profile.at(from, time).velocity, -1e-9);
  }
  EXPECT_LT(fastest, 0.06);
  EXPECT_NEAR(profile.duration(), 20.0, 1e-9);
}

TEST(AxisMotion, OfAnAxisThatIsAtItsTargetDoesNotMoveWhileOthersDo) {
  Limits limits = unit;
  limits.max_acceleration = 3.0;
  const AxisMotion motion{{.position = 2.0}, {.position = 2.0}, limits, Goal::position};

  const Profile profile = motion.profile(7.0);

  for (const Segment& segment : profile.segments()) EXPECT_EQ(segment.jerk, 0.0);
  EXPECT_EQ(profile.duration(), 7.0);
}

/// A task class and a goal.
class AnyTask : public testing::TestWithParam<int> {
 protected:
  static constexpr int number = 20'000;
  TaskClass which() const { return static_cast<TaskClass>(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(All, AnyTask, testing::Range(0, task_classes));

TEST_P(AnyTask, HasAMotionThatEndsAtTheTargetAndKeepsItsLimits) {
  RandomTasks tasks{1};
  for (int i = 0; i < number; ++i) {
    const AxisTask task = tasks.next(which());
    const AxisMotion motion{task.from, task.to, task.limits, Goal::position};
    const double duration = motion.possible(0.0);
    const Profile profile = motion.profile(duration);
    const Judge judge{task, profile.segments()};
    ASSERT_TRUE(std::isfinite(duration)) << i;
    ASSERT_NEAR(profile.duration(), duration, 1e-9 * (1.0 + duration)) << i;
    // Years of one cruise, which a start far outside its limits may need, cost digits.
    const double allowed = 1e-15 * std::max(duration, 1e6);
    ASSERT_LE(judge.verdict().end_error, std::max(1e-8, allowed)) << i;
    ASSERT_LE(judge.verdict().excess, std::max(1e-9, allowed)) << i;
  }
}

TEST_P(AnyTask, HasASlowerMotionThatIsAsGood) {
  RandomTasks tasks{2};
  for (int i = 0; i < number / 4; ++i) {
    const AxisTask task = tasks.next(which());
    const AxisMotion motion{task.from, task.to, task.limits, Goal::position};
    const double first = motion.possible(0.0);
    if (first > 1e4) continue;
    for (const double factor : {1.01, 1.5, 4.0}) {
      const double wanted = first * factor + 0.01;
      const double duration = motion.possible(wanted);
      const Profile profile = motion.profile(duration);
      const Judge judge{task, profile.segments()};
      ASSERT_GE(duration, wanted * (1.0 - 1e-12)) << i;
      ASSERT_NEAR(profile.duration(), duration, 1e-9 * (1.0 + duration)) << i;
      ASSERT_LE(judge.verdict().end_error, 1e-8) << i << ' ' << factor;
      ASSERT_LE(judge.verdict().excess, 1e-9) << i << ' ' << factor;
    }
  }
}

TEST_P(AnyTask, HasNoShorterMotionThanTheShortest) {
  // A motion of another duration is possible exactly if its end lies between the farthest two.
  RandomTasks tasks{3};
  for (int i = 0; i < number / 10; ++i) {
    const AxisTask task = tasks.next(which());
    const AxisMotion motion{task.from, task.to, task.limits, Goal::position};
    const double first = motion.possible(0.0);
    for (int part = 1; part < 50; ++part) {
      const double shorter = first * part / 50;
      ASSERT_GE(motion.possible(shorter), first * (1.0 - 1e-9)) << i << ' ' << part;
    }
  }
}

}  // namespace
}  // namespace takt::motion
