// Modes in which the program itself sends the set-points of the drives: the library of applications
// with a whole master, its gateway and simulated drives in virtual time.
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
using enum DriveMode;

constexpr std::size_t shoulder = 0;
constexpr std::size_t elbow = 1;

Obstacle obstacle_of(const Done& done) { return done ? Obstacle{.text = "none"} : done.error(); }

class AxesSetPoints : public ::testing::Test {
 protected:
  static constexpr const char* network = TAKT_SOURCE_DIR "/test/motions/data/all_modes.yaml";
  static constexpr std::chrono::milliseconds timeout = 10s;

  AxesSetPoints() {
    bus_.run(1000);  // until both nodes have booted
    bus_.clocks.offset = std::chrono::system_clock::now().time_since_epoch() - bus_.world.now();
  }
  void open(DriveMode mode) {
    auto opened = Axes::open(std::make_unique<LinkInVirtualTime>(bus_),
                             {.bus = "demo", .longest = 10s, .timeout = timeout});
    ASSERT_TRUE(opened) << opened.error().text;
    axes_.emplace(std::move(*opened));
    const Done enabled = axes_->enable();
    ASSERT_TRUE(enabled) << enabled.error().text;
    const Done set = axes_->set_mode(mode);
    ASSERT_TRUE(set) << set.error().text;
  }
  static ProfileBounds slow() {
    return {.velocity = Eigen::VectorXd::Constant(1, 2.0),
            .acceleration = Eigen::VectorXd::Constant(1, 20.0)};
  }
  std::int64_t value(std::size_t axis, std::uint16_t index) {
    const NodeId node = bus_.network.plan.nodes[bus_.axes[axis].node_index].id;
    return bus_.world.device(node)->objects().number({index, 0});
  }
  double velocity(std::size_t axis) {
    return MotionBus::scale * static_cast<double>(value(axis, 0x606C));
  }
  void expect_rest() {
    const double before = bus_.position(shoulder);
    bus_.run(50);
    EXPECT_NEAR(bus_.position(shoulder), before, 2 * MotionBus::scale);
  }
  /// Returns the largest velocity that an axis has in a cycle of this work, computed from its
  /// positions.
  template <class Work>
  double fastest(Work work) {
    double before = bus_.position(shoulder);
    double found = 0.0;
    bus_.each_cycle = [&] {
      const double now = bus_.position(shoulder);
      found = std::max(found, std::abs(now - before) / 0.002);
      before = now;
    };
    work();
    bus_.each_cycle = {};
    return found;
  }

  test::ClockAhead clock_;
  MotionBus bus_{{}, network};
  std::optional<Axes> axes_;
};

TEST_F(AxesSetPoints, AProfileMoveEndsAtItsTargetAndCyclicModeGoesOnWithoutAJump) {
  ASSERT_NO_FATAL_FAILURE(open(profile_position));
  const double speed = fastest([&] {
    const Done moved = axes_->profile_move(Eigen::Vector2d{1.5, -0.5}, slow());
    ASSERT_TRUE(moved) << moved.error().text;
  });
  EXPECT_NEAR(bus_.position(shoulder), 1.5, 2e-3);
  EXPECT_NEAR(bus_.position(elbow), -0.5, 2e-3);
  EXPECT_NEAR(speed, 2.0, 0.6) << "0x6081";
  EXPECT_NEAR(static_cast<double>(value(shoulder, 0x6084)), 20.0 / MotionBus::scale, 1.0);
  const Done relative = axes_->profile_move(Eigen::Vector2d{-0.5, -0.5}, {}, {.relative = true});
  ASSERT_TRUE(relative) << relative.error().text;
  EXPECT_NEAR(bus_.position(shoulder), 1.0, 2e-3);
  const double change = fastest([&] { ASSERT_TRUE(axes_->enable()); });
  EXPECT_LT(change, 0.5);
  EXPECT_TRUE(axes_->move(Eigen::Vector2d{0.0, 0.0}));
}

TEST_F(AxesSetPoints, ANewTargetCountsAtOnceOrAfterTheLastOne) {
  ASSERT_NO_FATAL_FAILURE(open(profile_position));
  ASSERT_TRUE(axes_->profile_move(Eigen::Vector2d{1.0, 1.0}, slow(), {.wait = false}));
  const Done second = axes_->profile_move(Eigen::Vector2d{0.5, 0.5}, {},
                                          {.timing = SetPointTiming::after_the_last});
  ASSERT_TRUE(second) << second.error().text;
  EXPECT_NEAR(bus_.position(shoulder), 0.5, 2e-3);
  ASSERT_TRUE(axes_->profile_move(Eigen::Vector2d{30.0, 30.0}, {}, {.wait = false}));
  double farthest = 0.0;
  bus_.each_cycle = [&] { farthest = std::max(farthest, bus_.position(shoulder)); };
  const Done back = axes_->profile_move(Eigen::Vector2d{0.0, 0.0});
  bus_.each_cycle = {};
  ASSERT_TRUE(back) << back.error().text;
  EXPECT_LT(farthest, 25.0);
  EXPECT_NEAR(bus_.position(shoulder), 0.0, 2e-3);
}

TEST_F(AxesSetPoints, ABufferedTargetIsReachedAfterTheFirst) {
  ASSERT_NO_FATAL_FAILURE(open(profile_position));
  double farthest = 0.0;
  bus_.each_cycle = [&] { farthest = std::max(farthest, bus_.position(shoulder)); };
  ASSERT_TRUE(axes_->profile_move(Eigen::Vector2d{1.0, 1.0}, slow(), {.wait = false}));
  ASSERT_TRUE(axes_->profile_move(Eigen::Vector2d{0.5, 0.5}, {},
                                  {.timing = SetPointTiming::after_the_last}));
  bus_.each_cycle = {};
  EXPECT_NEAR(farthest, 1.0, 1e-2);
  EXPECT_NEAR(bus_.position(shoulder), 0.5, 2e-3);
}

TEST_F(AxesSetPoints, AStoppedProfileMoveDoesNotGoOn) {
  ASSERT_NO_FATAL_FAILURE(open(profile_position));
  ASSERT_TRUE(axes_->profile_move(Eigen::Vector2d{90.0, 90.0}, slow(), {.wait = false}));
  bus_.run(200);
  ASSERT_GT(velocity(shoulder), 0.5);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(axes_->run(1us));
  EXPECT_NEAR(MotionBus::scale * static_cast<double>(bus_.target(shoulder)),
              bus_.position(shoulder), 0.1)
      << "the target position follows the actual one";
  const Done stopped = axes_->stop();
  ASSERT_TRUE(stopped) << stopped.error().text;
  EXPECT_EQ(value(shoulder, 0x6040) & 0x100, 0);
  expect_rest();
  EXPECT_LT(bus_.position(shoulder), 80.0);
  const double stood = bus_.position(shoulder);
  ASSERT_TRUE(axes_->profile_move(Eigen::Vector2d{0.5, 0.5}, {}, {.relative = true}));
  EXPECT_NEAR(bus_.position(shoulder), stood + 0.5, 5e-3);
}

TEST_F(AxesSetPoints, AHaltedProfileMoveGoesOn) {
  ASSERT_NO_FATAL_FAILURE(open(profile_position));
  ASSERT_TRUE(axes_->profile_move(Eigen::Vector2d{20.0, 20.0}, slow(), {.wait = false}));
  bus_.run(100);
  const Done halted = axes_->halt();
  ASSERT_TRUE(halted) << halted.error().text;
  expect_rest();
  EXPECT_LT(bus_.position(shoulder), 19.0);
  EXPECT_THAT(obstacle_of(axes_->profile_move(Eigen::Vector2d{0.0, 0.0})).text,
              HasSubstr("halted"));
  ASSERT_TRUE(axes_->resume());
  const Done reached = axes_->wait();
  ASSERT_TRUE(reached) << reached.error().text;
  EXPECT_NEAR(bus_.position(shoulder), 20.0, 2e-3);
}

TEST_F(AxesSetPoints, VelocitiesAreHeldUntilAStop) {
  for (const DriveMode mode : {cyclic_velocity, profile_velocity}) {
    SCOPED_TRACE(std::to_underlying(mode));
    ASSERT_NO_FATAL_FAILURE(open(mode));
    const Done begun = axes_->command_velocities(Eigen::Vector2d{2.0, -1.0});
    ASSERT_TRUE(begun) << begun.error().text;
    ASSERT_TRUE(axes_->run(20ms));
    bus_.run(300);
    EXPECT_NEAR(velocity(shoulder), 2.0, 0.05);
    EXPECT_NEAR(velocity(elbow), -1.0, 0.05);
    const Done stopped = axes_->stop();
    ASSERT_TRUE(stopped) << stopped.error().text;
    EXPECT_EQ(value(shoulder, 0x60FF), 0);
    expect_rest();
    const double change = fastest([&] { ASSERT_TRUE(axes_->set_mode(cyclic_position)); });
    EXPECT_LT(change, 0.5) << "the target position follows the actual one";
    EXPECT_TRUE(axes_->move_by(Eigen::Vector2d{0.1, 0.1}));
    axes_.reset();
  }
}

TEST_F(AxesSetPoints, AStopLowersAVelocityThatTheDrivesFollowAtOnce) {
  ASSERT_NO_FATAL_FAILURE(open(cyclic_velocity));
  constexpr double deceleration = 10.0;  // rad/s^2
  for (const char* node : {"shoulder", "elbow"}) {
    ASSERT_TRUE(axes_->write_number<std::uint32_t>(
        node, 0x6084, 0, static_cast<std::uint32_t>(deceleration / MotionBus::scale)));
  }
  ASSERT_TRUE(axes_->command_velocities(Eigen::Vector2d{4.0, -2.0}));
  ASSERT_TRUE(axes_->run(20ms));
  std::int64_t before = value(shoulder, 0x60FF);
  std::int64_t steepest = 0;
  int falling = 0;
  bus_.each_cycle = [&] {
    const std::int64_t now = value(shoulder, 0x60FF);
    steepest = std::max(steepest, std::abs(now - before));
    if (now != before) ++falling;
    before = now;
  };
  const Done stopped = axes_->stop();
  bus_.each_cycle = {};
  ASSERT_TRUE(stopped) << stopped.error().text;
  EXPECT_EQ(value(shoulder, 0x60FF), 0);
  EXPECT_EQ(value(elbow, 0x60FF), 0);
  EXPECT_GT(falling, 50);
  // If a command has come late, one step contains the change of several cycles.
  EXPECT_LT(static_cast<double>(steepest) * MotionBus::scale, 1.0);
  expect_rest();
}

TEST_F(AxesSetPoints, AreGivenUpAfterASilence) {
  ASSERT_NO_FATAL_FAILURE(open(cyclic_velocity));
  ASSERT_TRUE(axes_->command_velocities(Eigen::Vector2d{1.0, 1.0}));
  clock_.ahead = timeout + 100ms;
  const Obstacle lost = obstacle_of(axes_->run(10ms));
  EXPECT_EQ(lost.kind, Kind::stopped);
  EXPECT_THAT(lost.text, HasSubstr("its set-points were discarded"));
  EXPECT_EQ(value(shoulder, 0x60FF), 0);
}

TEST_F(AxesSetPoints, EachAxisHasItsMode) {
  ASSERT_NO_FATAL_FAILURE(open(cyclic_position));
  const Done set = axes_->set_mode(elbow, cyclic_velocity);
  ASSERT_TRUE(set) << set.error().text;
  EXPECT_EQ(value(shoulder, 0x6061), 8);
  EXPECT_EQ(value(elbow, 0x6061), 9);
  EXPECT_THAT(obstacle_of(axes_->move(Eigen::Vector2d{1.0, 1.0})).text,
              HasSubstr("cyclic synchronous position mode (8) on all axes"));
  EXPECT_THAT(obstacle_of(axes_->set_mode(2, cyclic_velocity)).text, HasSubstr("axis 2 of 2"));
}

TEST_F(AxesSetPoints, NeedTheirModeTheirMappingAndTheirLimits) {
  ASSERT_NO_FATAL_FAILURE(open(cyclic_velocity));
  const Eigen::Vector2d one{1.0, 1.0};
  EXPECT_THAT(obstacle_of(axes_->command_torques(one)).text,
              HasSubstr("shoulder is in mode 9, and this needs mode 4 or 10: call set_mode()"));
  EXPECT_EQ(obstacle_of(axes_->command_velocities(Eigen::VectorXd::Ones(3))).kind, Kind::wrong_use);
  EXPECT_EQ(obstacle_of(axes_->command_velocities(Eigen::Vector2d{1.0, std::nan("")})).kind,
            Kind::wrong_use);
  const Obstacle fast = obstacle_of(axes_->command_velocities(Eigen::Vector2d{50.0, 0.0}));
  EXPECT_EQ(fast.kind, Kind::refused);
  EXPECT_THAT(fast.text, HasSubstr("shoulder"));
  EXPECT_EQ(value(shoulder, 0x60FF), 0);
}

TEST(AxesWithTorques, AreHeldUntilAStop) {
  MotionBus bus{{}, TAKT_SOURCE_DIR "/test/motions/data/servos.yaml"};
  auto axes = Axes::open(std::make_unique<LinkInVirtualTime>(bus),
                         {.bus = "demo", .longest = 2s, .timeout = 10s});
  ASSERT_TRUE(axes);
  const Done enabled = axes->enable();
  ASSERT_TRUE(enabled) << enabled.error().text;
  const auto torque = [&] {
    const NodeId node = bus.network.plan.nodes[bus.axes[0].node_index].id;
    return bus.world.device(node)->objects().number({0x6071, 0});
  };
  for (const DriveMode mode : {profile_torque, cyclic_torque}) {
    SCOPED_TRACE(std::to_underlying(mode));
    const Done set = axes->set_mode(mode);
    ASSERT_TRUE(set) << set.error().text;
    const Done begun = axes->command_torques(Eigen::Vector2d{0.05, -0.05});
    ASSERT_TRUE(begun) << begun.error().text;
    EXPECT_EQ(torque(), 50);
    bus.run(20);
    EXPECT_EQ(torque(), 50);
    // A motor without friction coasts.
    [[maybe_unused]] const Done stopped = axes->stop();
    EXPECT_EQ(torque(), 0);
    [[maybe_unused]] const Done disabled = axes->disable();
    const Done again = axes->enable();
    ASSERT_TRUE(again) << again.error().text;
  }
}

TEST(AxesWithoutSetPoints, SayWhichObjectIsNotMapped) {
  MotionBus bus;
  auto axes = Axes::open(std::make_unique<LinkInVirtualTime>(bus), {.bus = "demo", .timeout = 10s});
  ASSERT_TRUE(axes);
  ASSERT_TRUE(axes->enable());
  ASSERT_TRUE(axes->set_mode(cyclic_velocity));
  EXPECT_THAT(obstacle_of(axes->command_velocities(Eigen::Vector2d{1.0, 1.0})).text,
              HasSubstr("shoulder: 0x60FF is in no RPDO"));
}

}  // namespace
}  // namespace takt
