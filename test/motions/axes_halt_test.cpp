// Halt and quick stop by the library of applications, with a whole master, its gateway and
// simulated drives in virtual time.
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
using Kind = Obstacle::Kind;

Obstacle obstacle_of(const Done& done) { return done ? Obstacle{.text = "none"} : done.error(); }

class AxesHalt : public ::testing::Test {
 protected:
  AxesHalt() {
    auto opened = Axes::open(std::make_unique<LinkInVirtualTime>(bus_),
                             {.bus = "demo", .longest = 2s, .timeout = 10s});
    EXPECT_TRUE(opened) << opened.error().text;
    axes_.emplace(std::move(*opened));
  }
  /// Lets both axes turn at 2 rad/s.
  void jog() {
    const Done enabled = axes_->enable();
    ASSERT_TRUE(enabled) << enabled.error().text;
    const Done begun = axes_->jog(Eigen::Vector2d{2.0, 2.0}, bounds());
    ASSERT_TRUE(begun) << begun.error().text;
    bus_.run(100);
    ASSERT_EQ(bus_.axis(0).state, test::moving);
  }
  static MotionBounds bounds() {
    return {.velocity = Eigen::VectorXd::Constant(1, 3.0),
            .acceleration = Eigen::VectorXd::Constant(1, 20.0)};
  }
  std::int64_t value(std::size_t axis, std::uint16_t index) {
    const NodeId node = bus_.network.plan.nodes[bus_.axes[axis].node_index].id;
    return bus_.world.device(node)->objects().number({index, 0});
  }
  void expect_rest() {
    const double before = bus_.position(0);
    bus_.run(50);
    EXPECT_NEAR(bus_.position(0), before, 2 * MotionBus::scale);
  }

  MotionBus bus_;
  std::optional<Axes> axes_;
};

TEST_F(AxesHalt, StandUntilTheyResumeWithoutAJump) {
  ASSERT_NO_FATAL_FAILURE(jog());
  const Done halted = axes_->halt();
  ASSERT_TRUE(halted) << halted.error().text;
  EXPECT_EQ(value(0, 0x6040) & 0x10F, 0x10F);
  EXPECT_TRUE(bus_.enabled(0)) << "a Halt is no quick stop";
  expect_rest();
  const Obstacle why = obstacle_of(axes_->move(Eigen::Vector2d{0.0, 0.0}, bounds()));
  EXPECT_EQ(why.kind, Kind::blocked);
  EXPECT_THAT(why.text, HasSubstr("halted: call resume() first"));
  EXPECT_THAT(obstacle_of(axes_->home()).text, HasSubstr("halted"));
  const double stood = bus_.position(0);
  const Done resumed = axes_->resume();
  ASSERT_TRUE(resumed) << resumed.error().text;
  EXPECT_EQ(value(0, 0x6040) & 0x10F, 0x00F);
  EXPECT_NEAR(bus_.position(0), stood, 2 * MotionBus::scale);
  expect_rest();
  const Done moved = axes_->move(Eigen::Vector2d{0.0, 0.0}, bounds());
  EXPECT_TRUE(moved) << moved.error().text;
}

TEST_F(AxesHalt, ConfirmAQuickStopAndAreEnabledAgain) {
  ASSERT_NO_FATAL_FAILURE(jog());
  const Done stopped = axes_->quick_stop();
  ASSERT_TRUE(stopped) << stopped.error().text;
  EXPECT_FALSE(bus_.enabled(0));
  EXPECT_FALSE(axes_->moving());
  expect_rest();
  EXPECT_THAT(obstacle_of(axes_->jog(Eigen::Vector2d{1.0, 1.0})).text,
              HasSubstr("call enable() first"));
  ASSERT_TRUE(axes_->enable());
  EXPECT_TRUE(axes_->move(Eigen::Vector2d{0.0, 0.0}, bounds()));
}

TEST_F(AxesHalt, NeedAProgramThatHasEnabledThem) {
  for (const Done& done : {axes_->halt(), axes_->quick_stop()}) {
    EXPECT_THAT(obstacle_of(done).text, HasSubstr("call enable() first"));
  }
  EXPECT_TRUE(axes_->resume()) << "nothing is halted";
}

}  // namespace
}  // namespace takt
