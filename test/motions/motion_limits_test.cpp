// Which limits the motions of an axis have.
#include <gtest/gtest.h>

#include "eds_parser/network_file/load_network.hpp"
#include "master/gateway/motion/axis_motion_limits.hpp"
#include "test/motions/motion_bus.hpp"

namespace takt {
namespace {

using test::MotionBus;

struct MotionLimits : testing::Test {
  LimitLine& line(LimitKind kind) {
    for (LimitLine& one : plan.limits.lines) {
      if (one.node_index == 0 && one.kind == kind) return one;
    }
    ADD_FAILURE() << "the file has no such limit";
    return plan.limits.lines.front();
  }
  /// Returns why the shoulder may not have this velocity; empty if it may.
  static std::string objection(const AxisMotionLimits& limits, double velocity) {
    motion_goal_t goal = MotionBus::goal("shoulder", 0.0);
    goal.max_velocity = velocity;
    const auto found = limits.of(0, goal);
    return found ? "" : found.error();
  }
  BusPlan plan = load_network(MotionBus::demo).plan;
};

/// The limit allows 0.05 rad less a count in 2 ms.
TEST_F(MotionLimits, ALimitOfTheStepLimitsTheVelocity) {
  line(LimitKind::step).high = 0.05;
  const AxisMotionLimits limits{plan};
  EXPECT_EQ(objection(limits, 24.6), "");
  EXPECT_NE(objection(limits, 24.8), "");
}

TEST_F(MotionLimits, ALimitThatIsReadFromTheDriveLimitsItsMotions) {
  LimitLine& velocity = line(LimitKind::velocity);
  velocity.source = LimitSource::device;
  velocity.high.reset();
  velocity.scale = 0.001;
  AxisMotionLimits limits{plan};
  EXPECT_EQ(objection(limits, 6.0), "");
  const auto place = static_cast<std::size_t>(&velocity - plan.limits.lines.data());
  limits.learn(plan, place, 5000);
  EXPECT_NE(objection(limits, 6.0), "");
  EXPECT_EQ(objection(limits, 5.0), "");
}

TEST_F(MotionLimits, ARangeThatIsReadFromTheDriveIsThatOfItsMotions) {
  LimitLine& position = line(LimitKind::position);
  position.source = LimitSource::device;
  position.low.reset();
  position.high.reset();
  position.scale = 0.01;
  AxisMotionLimits limits{plan};
  const auto place = static_cast<std::size_t>(&position - plan.limits.lines.data());
  limits.learn(plan, place, std::int64_t{-300} * 0x1'0000'0000 + 500);
  EXPECT_DOUBLE_EQ(limits.range(0).min, -3.0);
  EXPECT_DOUBLE_EQ(limits.range(0).max, 5.0);
}

}  // namespace
}  // namespace takt
