// The feed-forward of torque of a motion (60B2).
#include "test/unit/master/rt/motion/driven_axis_bench.hpp"

namespace takt {
namespace {

using motion::AxisState;
using test::Bench;

/// The torque offset is in RPDO3, in thousandths of the rated torque.
BusPlan plan_with_torque(FeedForwardPlan feed_forward) {
  BusPlan plan = test::one_axis();
  Signal torque = test::make_signal(1_node, 0, {0x60B2, 0});
  torque.type = DataType::integer16;
  torque.bits = 16;
  torque.output = true;
  torque.row = 2;
  torque.scale = 0.001;
  torque.unit = "of rated torque";
  plan.layout.signals.push_back(torque);
  test::add_pdo(plan, false, {.cob_id = CobId::base(0x401), .node = 1_node, .transmission = 1},
                {{.signal = 5, .bit_offset = 0, .bits = 16, .sign_extend = true}});
  plan.nodes[0].axes = {{.number = 0, .feed_forward = feed_forward}};
  return plan;
}

class TorqueBench : public Bench {
 public:
  explicit TorqueBench(BusPlan made) : Bench{std::move(made)} {
    command(3, 0);
    pack();
    hear(0x1027, 0);
    axis.read(pdos, true, last);
  }
  std::int64_t torque() const { return pdos.image().values[5]; }
};

constexpr FeedForwardPlan inertia_and_friction{.torque_per_acceleration = 0.01,
                                               .torque_per_velocity = 0.02};

TEST(DrivenAxisTorque, IsThatOfTheAccelerationAndTheVelocity) {
  TorqueBench bench{plan_with_torque(inertia_and_friction)};
  ASSERT_TRUE(
      bench.write(AxisState::moving, {.position = 0.0, .velocity = 3.0, .acceleration = -20.0}));
  EXPECT_EQ(bench.torque(), -140);
  ASSERT_TRUE(
      bench.write(AxisState::stopping, {.position = 0.0, .velocity = -1.0, .acceleration = 5.0}));
  EXPECT_EQ(bench.torque(), 30);
}

TEST(DrivenAxisTorque, IsZeroWhenTheAxisStands) {
  TorqueBench bench{plan_with_torque(inertia_and_friction)};
  ASSERT_TRUE(bench.write(AxisState::moving, {.velocity = 3.0, .acceleration = 20.0}));
  ASSERT_NE(bench.torque(), 0);
  ASSERT_TRUE(bench.write(AxisState::standing, {.position = 0.0}));
  EXPECT_EQ(bench.torque(), 0);
  ASSERT_TRUE(bench.write(AxisState::moving, {.velocity = 3.0, .acceleration = 20.0}));
  EXPECT_FALSE(bench.write(AxisState::moving, {.position = 1e12, .velocity = 3.0}))
      << "a position that INTEGER32 cannot hold";
  EXPECT_EQ(bench.torque(), 0);
}

TEST(DrivenAxisTorque, KeepsTheLimitOfTorqueAndTheWidthOfItsObject) {
  BusPlan plan = plan_with_torque(inertia_and_friction);
  TorqueBench wide{plan};
  ASSERT_TRUE(wide.write(AxisState::moving, {.acceleration = 1e9}));
  EXPECT_EQ(wide.torque(), 32767);
  ASSERT_TRUE(wide.write(AxisState::moving, {.acceleration = -1e9}));
  EXPECT_EQ(wide.torque(), -32768);

  plan.limits.outputs.push_back(
      {.signal = 5, .low = -150, .high = 150, .range = LimitKind::torque});
  TorqueBench narrow{plan};
  ASSERT_TRUE(narrow.write(AxisState::moving, {.acceleration = 20.0}));
  EXPECT_EQ(narrow.torque(), 150) << "the motion goes on";
  ASSERT_TRUE(narrow.write(AxisState::moving, {.acceleration = -20.0}));
  EXPECT_EQ(narrow.torque(), -150);
}

/// The application may command the torque offset.
TEST(DrivenAxisTorque, IsLeftAloneWithoutAFeedForward) {
  BusPlan plan = plan_with_torque({});
  plan.nodes[0].axes[0].feed_forward.reset();
  TorqueBench bench{plan};
  bench.command(3, 77);
  bench.pack();
  ASSERT_TRUE(bench.write(AxisState::moving, {.velocity = 3.0, .acceleration = 20.0}));
  bench.pack();
  EXPECT_EQ(bench.torque(), 77);
  ASSERT_TRUE(bench.write(AxisState::standing, {}));
  EXPECT_EQ(bench.torque(), 77);
}

}  // namespace
}  // namespace takt
