// Homing by the library of applications, with a whole master, its gateway and simulated drives in
// virtual time.
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

class AxesHome : public ::testing::Test {
 protected:
  static constexpr const char* network = TAKT_SOURCE_DIR "/test/motions/data/homing.yaml";
  static constexpr std::size_t shoulder = 0;
  static constexpr std::size_t elbow = 1;
  static constexpr auto csp = 8;

  Axes open(std::vector<std::string> names = {}) {
    auto axes = Axes::open(std::make_unique<LinkInVirtualTime>(bus_),
                           {.bus = "demo",
                            .names = std::move(names),
                            .longest = 100s,
                            .timeout = 10s,
                            .interrupted = [this] { return interrupts_ && interrupts_(); }});
    EXPECT_TRUE(axes) << axes.error().text;
    return std::move(*axes);
  }
  static void enable(Axes& axes) {
    const Done enabled = axes.enable();
    ASSERT_TRUE(enabled) << enabled.error().text;
  }
  sim::ObjectStore& objects(std::size_t axis) {
    const NodeId node = bus_.network.plan.nodes[bus_.axes[axis].node_index].id;
    return bus_.world.device(node)->objects();
  }
  std::int64_t value(std::size_t axis, std::uint16_t index) {
    return objects(axis).number({index, 0});
  }
  bool seeks(std::size_t axis) {
    return value(axis, 0x6061) == 6 && std::abs(value(axis, 0x606C)) > 1000;
  }
  void expect_rest(std::size_t axis) {
    const double before = bus_.position(axis);
    bus_.run(50);
    EXPECT_NEAR(bus_.position(axis), before, 2 * MotionBus::scale);
  }
  static MotionBounds slow() {
    return {.velocity = Eigen::VectorXd::Constant(1, 3.0),
            .acceleration = Eigen::VectorXd::Constant(1, 20.0)};
  }

  MotionBus bus_{{}, network};
  std::function<bool()> interrupts_;
};

Obstacle obstacle_of(const Done& done) { return done ? Obstacle{.text = "none"} : done.error(); }

TEST_F(AxesHome, AnAbsoluteMotionNeedsAHomedAxisAndARelativeOneDoesNot) {
  Axes axes = open();
  ASSERT_NO_FATAL_FAILURE(enable(axes));
  EXPECT_TRUE(axes.needs_homing(shoulder));
  EXPECT_FALSE(axes.homed(shoulder));
  const Obstacle refused = obstacle_of(axes.move(Eigen::Vector2d{1.0, 1.0}, slow()));
  EXPECT_EQ(refused.kind, Kind::refused);
  EXPECT_THAT(refused.text, HasSubstr("the axis is not homed"));
  EXPECT_THAT(refused.text, HasSubstr("home it first"));
  EXPECT_TRUE(axes.move_by(Eigen::Vector2d{0.1, -0.1}, slow()));
  ASSERT_TRUE(axes.jog(Eigen::Vector2d{0.1, 0.1}, slow()));
  EXPECT_TRUE(axes.stop());

  const Done homed = axes.home();
  ASSERT_TRUE(homed) << homed.error().text;
  EXPECT_TRUE(axes.homed(shoulder) && axes.homed(elbow));
  EXPECT_TRUE(bus_.said("homed", "shoulder: the axis is homed"));
  const Done moved = axes.move(Eigen::Vector2d{1.0, 1.0}, slow());
  ASSERT_TRUE(moved) << moved.error().text;
  bus_.run(20);
  EXPECT_NEAR(bus_.position(elbow), 1.0, 2e-3);
}

TEST_F(AxesHome, TheTargetsFollowTheNewPositions) {
  Axes axes = open();
  ASSERT_NO_FATAL_FAILURE(enable(axes));
  ASSERT_TRUE(axes.move_by(Eigen::Vector2d{3.0, 3.0}, slow()));
  const Done homed = axes.home();
  ASSERT_TRUE(homed) << homed.error().text;
  EXPECT_NEAR(bus_.position(shoulder), -0.5, 2e-3) << "the home position reads minus the offset";
  EXPECT_NEAR(axes.commanded_positions()(shoulder), -0.5, 2e-3);
  for (const std::size_t axis : {shoulder, elbow}) {
    EXPECT_EQ(value(axis, 0x6061), csp);
    EXPECT_TRUE(bus_.enabled(axis));
    EXPECT_NEAR(static_cast<double>(bus_.target(axis)), static_cast<double>(value(axis, 0x6064)),
                2.0);
    expect_rest(axis);
  }
}

TEST_F(AxesHome, OneAfterTheOtherOrTogether) {
  Axes axes = open();
  ASSERT_NO_FATAL_FAILURE(enable(axes));
  bool both = false;
  bus_.each_cycle = [&] { both |= value(shoulder, 0x6061) == 6 && value(elbow, 0x6061) == 6; };
  ASSERT_TRUE(axes.home());
  EXPECT_FALSE(both);
  ASSERT_TRUE(axes.home({.order = HomingOptions::Order::together}));
  EXPECT_TRUE(both);
  bus_.each_cycle = {};
}

TEST_F(AxesHome, EnablesTheDrivesItself) {
  Axes axes = open({"elbow"});
  const Done homed = axes.home();
  ASSERT_TRUE(homed) << homed.error().text;
  EXPECT_TRUE(bus_.enabled(elbow));
  EXPECT_FALSE(bus_.enabled(shoulder));
}

TEST_F(AxesHome, SaysThatTheDriveReportsAnError) {
  Axes axes = open({"elbow"});
  ASSERT_NO_FATAL_FAILURE(enable(axes));
  objects(elbow).find({0x6098, 0})->set(36);  // the simulated drive has no such method
  const Obstacle failed = obstacle_of(axes.home());
  EXPECT_EQ(failed.kind, Kind::stopped);
  EXPECT_THAT(failed.text, HasSubstr("elbow: the drive reports a homing error: bit 13"));
  EXPECT_TRUE(bus_.said("homing_failed", "elbow: the drive reports a homing error"));
  EXPECT_TRUE(bus_.enabled(elbow)) << "it can be moved by distances and jogged";
  EXPECT_FALSE(axes.homed(0));
  EXPECT_EQ(value(elbow, 0x6061), csp);
  EXPECT_THAT(obstacle_of(axes.move(Eigen::VectorXd::Constant(1, 1.0), slow())).text,
              HasSubstr("the last homing of the axis has failed"));
  EXPECT_TRUE(axes.move_by(Eigen::VectorXd::Constant(1, 0.1), slow()));
}

TEST_F(AxesHome, EndsAtItsTimeLimitAndStopsTheAxis) {
  Axes axes = open({"elbow"});
  ASSERT_NO_FATAL_FAILURE(enable(axes));
  objects(elbow).find({0x6099, 1})->set(2'000'000);  // the switch is far away
  objects(elbow).find({0x609A, 0})->set(20);         // and the axis is slow
  const Obstacle late = obstacle_of(axes.home({.longest = 1ms}));
  EXPECT_EQ(late.kind, Kind::time_over);
  EXPECT_THAT(late.text, HasSubstr("elbow: the homing has not ended after 0.0 s"));
  EXPECT_TRUE(bus_.said("homing_failed", "was broken off before it had a result"));
  EXPECT_EQ(value(elbow, 0x6061), csp);
  EXPECT_TRUE(bus_.enabled(elbow));
  expect_rest(elbow);
}

TEST_F(AxesHome, AnInterruptionStopsTheAxisBeforeTheModeChanges) {
  Axes axes = open({"elbow"});
  ASSERT_NO_FATAL_FAILURE(enable(axes));
  interrupts_ = [&] { return seeks(elbow); };
  std::int64_t fastest_outside = 0;
  bus_.each_cycle = [&] {
    if (value(elbow, 0x6061) == 6) return;
    fastest_outside = std::max(fastest_outside, std::abs(value(elbow, 0x606C)));
  };
  EXPECT_EQ(obstacle_of(axes.home()).kind, Kind::interrupted);
  interrupts_ = {};
  EXPECT_EQ(value(elbow, 0x6061), csp);
  EXPECT_TRUE(bus_.enabled(elbow));
  EXPECT_FALSE(axes.homed(0));
  bus_.each_cycle = {};
  expect_rest(elbow);
  EXPECT_LT(fastest_outside, 1000) << "it stood when the mode changed";
}

/// The program stands still in the middle of the homing, as if it had died.
TEST_F(AxesHome, WithoutItsProgramTheDriveStopsByItsFallback) {
  Axes axes = open({"elbow"});
  ASSERT_NO_FATAL_FAILURE(enable(axes));
  interrupts_ = [&] {
    if (!seeks(elbow)) return false;
    bus_.run(400);
    EXPECT_FALSE(bus_.enabled(elbow)) << "the fallback is quick_stop after 100 cycles";
    expect_rest(elbow);
    return true;
  };
  EXPECT_FALSE(axes.home());
  interrupts_ = {};
  EXPECT_FALSE(axes.homed(0));
}

TEST_F(AxesHome, ADeviceThatStartsAnewHasLostItsHome) {
  Axes axes = open({"elbow"});
  ASSERT_TRUE(axes.home());
  EXPECT_TRUE(axes.homed(0));
  const NodeId node = bus_.network.plan.nodes[bus_.axes[elbow].node_index].id;
  bus_.world.power(node, false);
  bus_.run(500);
  bus_.world.power(node, true);
  bus_.run(2000);
  ASSERT_TRUE(axes.run(1ms)) << "it hears that the drive has left Operation enabled";
  EXPECT_TRUE(bus_.said("homing_lost", "elbow: its node has stopped exchanging PDOs"));
  ASSERT_NO_FATAL_FAILURE(enable(axes));
  EXPECT_FALSE(axes.homed(0));
  EXPECT_EQ(obstacle_of(axes.move(Eigen::VectorXd::Constant(1, 1.0), slow())).kind, Kind::refused);
}

TEST_F(AxesHome, AStreamBeginsOnlyOnAHomedAxis) {
  bus_.enable();
  bus_.keep_alive();
  bus_.run(5);
  motion_point_t first{};
  first.position = {bus_.axis(elbow).position};
  first.velocity = {0.0};
  bus_.send_stream(9, {"elbow"}, 0, {first});
  bus_.run(3);
  EXPECT_TRUE(bus_.said("motion_refused", "motion 9 of 'test' refused: the axis is not homed"));
}

TEST_F(AxesHome, AGearKeepsAPhaseOnlyOnAHomedAxis) {
  bus_.enable();
  bus_.each_cycle = [&] { bus_.keep_alive(); };
  motion_gear_t gear = bus_.gear(9, "shoulder", 1.0);
  gear.phase = "at";
  bus_.send(gear);
  bus_.run(5);
  EXPECT_TRUE(bus_.said("motion_refused", "motion 9 of 'test' refused: the axis is not homed"));
  bus_.send(bus_.gear(10, "shoulder", 1.0));
  EXPECT_TRUE(bus_.run_until([&] { return bus_.axis(elbow).id == 10; }, 50));
  bus_.each_cycle = {};
}

}  // namespace
}  // namespace takt
