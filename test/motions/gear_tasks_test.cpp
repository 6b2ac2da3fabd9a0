// Which signals can be the leader of a gear.
#include <gtest/gtest.h>

#include "eds_parser/network_file/load_network.hpp"
#include "master/gateway/motion/gear_jobs.hpp"
#include "test/motions/motion_bus.hpp"

namespace takt {
namespace {

using test::MotionBus;

/// A gear of the elbow behind the actual position of the shoulder, whose signal a test changes.
class GearTasks : public testing::Test {
 protected:
  GearTasks() : network{load_network(MotionBus::demo)}, axes{motion_axes(network.plan)} {
    gear.leader = "shoulder";
    gear.signal = "position_actual_value";
    gear.goals = {MotionBus::goal("elbow", 0.0)};
    gear.numerator = {1.0};
    gear.denominator = {1.0};
    gear.max_phase_error = {0.0};
    gear.num_goals = 1;
  }
  Signal& leader() { return network.plan.layout.signals[axes[0].position]; }
  std::expected<std::vector<motion::GearTask>, MotionRefusal> tasks() {
    return gear_tasks(gear, std::array{std::size_t{1}}, {network.plan, axes, limits});
  }

  LoadedNetwork network;
  // The axes of the plan, before a test changes the plan.
  std::vector<MotionAxis> axes;
  AxisMotionLimits limits{network.plan};
  motion_gear_t gear{};
};

TEST_F(GearTasks, ALeaderIsAnIntegerOfAtLeastEightBits) {
  ASSERT_TRUE(tasks().has_value());
  EXPECT_EQ(tasks()->front().bits, 32);
  leader().type = DataType::real32;
  ASSERT_FALSE(tasks().has_value());
  EXPECT_NE(tasks().error().why.find("is no integer of at least 8 bits"), std::string::npos);
  leader().type = DataType::boolean;
  leader().bits = 1;
  EXPECT_FALSE(tasks().has_value());
  leader().type = DataType::integer8;
  leader().bits = 8;
  EXPECT_TRUE(tasks().has_value());
}

/// The demanded position of a drive follows its target at once, and so does a ring over it.
TEST_F(GearTasks, EachPositionOfADriveIsOneOfItsAxis) {
  const auto leads = [&](std::uint16_t index) {
    leader().object.index = index;
    return tasks()->front().leader_axis;
  };
  EXPECT_EQ(leads(0x6064), 0);
  EXPECT_EQ(leads(0x6062), 0);
  EXPECT_EQ(leads(0x6063), 0);
  EXPECT_EQ(leads(0x60FC), 0);
  EXPECT_EQ(leads(0x60E4), 0xFF) << "an encoder of its own";
}

}  // namespace
}  // namespace takt
