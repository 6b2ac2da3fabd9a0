// Motions of drives in interpolated position mode, with a whole master, its gateway and simulated
// drives in virtual time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <takt/motion.hpp>

#include "test/motions/link_in_virtual_time.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::LinkInVirtualTime;
using test::MotionBus;
using testing::HasSubstr;

constexpr std::uint16_t mode_is_active = 0x1000;  // bit 12 of the statusword

class AxesPoints : public ::testing::Test {
 protected:
  Axes open() {
    auto axes = Axes::open(std::make_unique<LinkInVirtualTime>(bus_),
                           {.bus = "demo", .longest = 100s, .timeout = 10s});
    EXPECT_TRUE(axes) << axes.error().text;
    return std::move(*axes);
  }
  static void enable(Axes& axes) {
    const Done enabled = axes.enable();
    ASSERT_TRUE(enabled) << enabled.error().text;
  }
  std::int64_t value(std::size_t axis, std::uint16_t index, std::uint8_t sub = 0) {
    const NodeId node = bus_.network.plan.nodes[bus_.axes[axis].node_index].id;
    return bus_.world.device(node)->objects().number({index, sub});
  }

  MotionBus bus_{{}, TAKT_SOURCE_DIR "/test/motions/data/interpolated.yaml"};
};

TEST_F(AxesPoints, TheBootOpensTheBufferAndEnablingActivatesTheMode) {
  Axes axes = open();
  ASSERT_NO_FATAL_FAILURE(enable(axes));
  EXPECT_EQ(value(0, 0x6061), 7);
  EXPECT_EQ(value(0, 0x60C4, 6), 1);
  EXPECT_NE(value(0, 0x6041) & mode_is_active, 0);
  EXPECT_TRUE(axes.disable());
}

TEST_F(AxesPoints, AMoveIsOnePointInEachCycle) {
  std::int64_t most = 0;
  int inactive = 0;
  Axes axes = open();
  ASSERT_NO_FATAL_FAILURE(enable(axes));
  bus_.each_cycle = [&] {
    most = std::max(most, value(0, 0x60C4, 4));
    inactive += (value(0, 0x6041) & mode_is_active) == 0 ? 1 : 0;
  };
  const Done moved = axes.move(Eigen::Vector2d{1.0, -2.0});
  ASSERT_TRUE(moved) << moved.error().text;
  bus_.run(500);
  EXPECT_NEAR(bus_.position(0), 1.0, 0.01);
  EXPECT_NEAR(bus_.position(1), -2.0, 0.01);
  EXPECT_LE(most, 3) << "points wait in the buffer, so the drive is late";
  EXPECT_EQ(inactive, 0);
}

TEST_F(AxesPoints, AModeThatEndsStopsBothAxesAndNamesIt) {
  const NodeId node = bus_.network.plan.nodes[bus_.axes[0].node_index].id;
  int cycles = 0;
  Axes axes = open();
  ASSERT_NO_FATAL_FAILURE(enable(axes));
  bus_.each_cycle = [&] {
    constexpr int in_motion = 500;
    if (++cycles == in_motion) bus_.world.device(node)->objects().find({0x60C4, 6})->set(0);
  };
  const Done ended = axes.move(Eigen::Vector2d{50.0, 50.0});
  ASSERT_FALSE(ended);
  EXPECT_THAT(ended.error().text, HasSubstr("the drive has ended interpolated position mode"));
  bus_.run(500);
  EXPECT_LT(bus_.position(1), 49.0) << "the other axis of the group stops, too";
}

}  // namespace
}  // namespace takt
