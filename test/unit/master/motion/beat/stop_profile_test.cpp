#include "master/motion/beat/stop_profile.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "master/motion/axis_motion.hpp"

namespace takt::motion {
namespace {

TEST(StopProfile, IsTheShortestMotionToRest) {
  std::mt19937_64 random{7};
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  for (int i = 0; i < 200'000; ++i) {
    const Limits limits{.max_velocity = 10.0,
                        .min_velocity = -10.0,
                        .max_acceleration = between(0.1, 5.0),
                        .min_acceleration = between(-5.0, -0.1),
                        .jerk = between(1.0, 100.0)};
    // One state of four is outside the limits of acceleration.
    const State from{.position = between(-1.0, 1.0),
                     .velocity = i % 5 == 0 ? 0.0 : between(-3.0, 3.0),
                     .acceleration = i % 7 == 0 ? 0.0 : between(-6.0, 6.0)};
    const Profile stop = stop_profile(from, limits);
    const State end = stop.end(from);
    ASSERT_NEAR(end.velocity, 0.0, 1e-11);
    ASSERT_NEAR(end.acceleration, 0.0, 1e-11);
    State state = from;
    for (const Segment& segment : stop.segments()) {
      ASSERT_LE(std::abs(segment.jerk), limits.jerk);
      state = advanced(state, segment.duration, segment.jerk);
      ASSERT_LE(state.acceleration, std::max(limits.max_acceleration, from.acceleration) + 1e-11);
      ASSERT_GE(state.acceleration, std::min(limits.min_acceleration, from.acceleration) - 1e-11);
    }
    const AxisMotion planned{from, State{}, limits, Goal::velocity};
    const double shortest = planned.profile(planned.possible(0.0)).duration();
    ASSERT_LE(stop.duration(), shortest + 1e-9 * (1.0 + shortest)) << i;
  }
}

TEST(StopProfile, OfAnAxisAtRestIsEmpty) {
  const Limits limits{.max_velocity = 1.0,
                      .min_velocity = -1.0,
                      .max_acceleration = 1.0,
                      .min_acceleration = -1.0,
                      .jerk = 1.0};
  EXPECT_TRUE(stop_profile({.position = 4.0}, limits).segments().empty());
}

}  // namespace
}  // namespace takt::motion
