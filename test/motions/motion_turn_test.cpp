// How the front thread treats a rotary axis.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "eds_parser/network_file/load_network.hpp"
#include "master/gateway/motion/axis_motion_limits.hpp"
#include "master/gateway/motion/motion_messages.hpp"
#include "test/motions/motion_bus.hpp"

namespace takt {
namespace {

constexpr double whole_turn = 2 * std::numbers::pi;

/// The demo, whose shoulder turns: 10,000 counts a turn.
LoadedNetwork network_with_turn() {
  LoadedNetwork network = load_network(test::MotionBus::demo);
  const SignalIndex target = motion_axes(network.plan).at(0).target;
  for (OutputLimit& row : network.plan.limits.outputs) {
    if (row.signal == target) row.modulus = 10'000.0;
  }
  return network;
}

TEST(MotionTurn, PositionsAreShownInsideTheTurn) {
  const LoadedNetwork network = network_with_turn();
  MotionSnapshot snapshot;
  snapshot.axes.resize(2);
  for (motion::AxisReport& axis : snapshot.axes) {
    axis.commanded.position = 3 * whole_turn + 1.0;
    axis.actual.position = -0.1;
    axis.following_error = 0.1;
  }
  const auto messages = motion_messages(network.plan, motion_axes(network.plan), snapshot,
                                        std::vector<ShownMotion>(2));
  const axis_motion_t& shoulder = messages.at(0).axes.at(0);
  EXPECT_NEAR(shoulder.position, 1.0, 1e-9);
  EXPECT_NEAR(shoulder.actual_position, whole_turn - 0.1, 1e-9);
  EXPECT_EQ(shoulder.following_error, 0.1);
  EXPECT_EQ(messages.at(0).axes.at(1).position, 3 * whole_turn + 1.0) << "no rotary axis";
}

/// The file permits -100 to 100 rad, which is more than a turn.
TEST(MotionTurn, ARotaryAxisHasNoRange) {
  const LoadedNetwork network = network_with_turn();
  const AxisMotionLimits limits{network.plan};
  EXPECT_NEAR(limits.turn(0), whole_turn, 1e-9);
  EXPECT_TRUE(std::isinf(limits.range(0).max));
  EXPECT_EQ(limits.turn(1), 0.0);
  EXPECT_EQ(limits.range(1).max, 100.0);
}

}  // namespace
}  // namespace takt
