#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <takt/motion.hpp>

#include "test/unit/apps/axis/motion_daemon.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::MotionDaemon;
using test::MotionDaemonTransport;
using ::testing::AllOf;
using ::testing::HasSubstr;
using Kind = Obstacle::Kind;

/// Duration of short waits, and longest time of calls that must end with an obstacle. Other calls
/// have the default of open().
constexpr auto short_time = 200ms;

class AxesOnABus : public ::testing::Test {
 protected:
  Axes open(std::vector<std::string> names = {}, std::chrono::nanoseconds longest = 100s) {
    auto axes = Axes::open(std::make_unique<MotionDaemonTransport>(daemon_),
                           {.bus = "lift", .names = std::move(names), .longest = longest});
    EXPECT_TRUE(axes) << axes.error().text;
    return std::move(*axes);
  }
  Axes open_enabled(std::vector<std::string> names = {}) {
    Axes axes = open(std::move(names));
    const Done done = axes.enable();
    EXPECT_TRUE(done) << done.error().text;
    return axes;
  }

  MotionDaemon daemon_;
};

Obstacle obstacle_of(const Done& done) { return done ? Obstacle{.text = "none"} : done.error(); }

TEST_F(AxesOnABus, MoveTogetherToTheirTargets) {
  Axes axes = open_enabled();
  ASSERT_TRUE(axes.move(Eigen::Vector2d{2.0, -1.0}));
  EXPECT_EQ(axes.positions(), Eigen::Vector2d(2.0, -1.0));
  ASSERT_EQ(daemon_.commands.size(), 1U) << "one command for both axes";
  EXPECT_EQ(daemon_.commands[0].goals.size(), 2U);
  ASSERT_TRUE(axes.move_by(Eigen::Vector2d{-0.5, 0.5}));
  EXPECT_EQ(axes.commanded_positions(), Eigen::Vector2d(1.5, -0.5));
}

TEST_F(AxesOnABus, CarryTheBoundsOfTheMotion) {
  Axes axes = open_enabled();
  ASSERT_TRUE(axes.move(Eigen::Vector2d{1.0, 1.0}, {.velocity = Eigen::VectorXd::Constant(1, 3.0),
                                                    .acceleration = Eigen::Vector2d{4.0, 5.0}}));
  const motion_goal_t& elbow = daemon_.commands.at(0).goals.at(1);
  EXPECT_EQ(elbow.max_velocity, 3.0);
  EXPECT_EQ(elbow.max_acceleration, 5.0);
  EXPECT_EQ(elbow.max_jerk, 0.0);
}

TEST_F(AxesOnABus, AreInTheOrderOfTheirNames) {
  Axes axes = open_enabled({"elbow", "shoulder"});
  EXPECT_EQ(axes.name(0), "elbow");
  ASSERT_TRUE(axes.move(Eigen::Vector2d{2.0, -1.0}));
  EXPECT_EQ(daemon_.drives[1].position, 2.0);
  EXPECT_EQ(daemon_.drives[0].position, -1.0);
}

TEST_F(AxesOnABus, LeaveTheAxesAloneThatAreNotNamed) {
  Axes axes = open_enabled({"elbow"});
  EXPECT_EQ(daemon_.drives[0].statusword, 0x0250);
  EXPECT_EQ(daemon_.drives[1].statusword, 0x0237);
  EXPECT_EQ(axes.size(), 1);
}

TEST_F(AxesOnABus, JogUntilTheyStop) {
  Axes axes = open_enabled({"shoulder"});
  ASSERT_TRUE(axes.jog(Eigen::VectorXd::Constant(1, -1.0)));
  EXPECT_TRUE(axes.moving());
  ASSERT_TRUE(axes.stop());
  EXPECT_FALSE(axes.moving());
  EXPECT_LT(daemon_.drives[0].position, 0.0);
  EXPECT_EQ(daemon_.commands.back().kind, "stop");
  EXPECT_TRUE(axes.wait()) << "no motion is left";
  EXPECT_TRUE(axes.move(Eigen::VectorXd::Constant(1, 0.0))) << "from an image after the stop";
  EXPECT_GT(daemon_.commands.back().cycle, daemon_.commands.rbegin()[1].cycle);
}

TEST_F(AxesOnABus, FollowALeaderUntilTheyStop) {
  Axes axes = open_enabled();
  const Gear gear{.leader = "wheel",
                  .signal = "position_value",
                  .ratio = Eigen::Vector2d{0.5, -2.0},
                  .phase = Eigen::VectorXd::Constant(1, 3.0),
                  .modulo = 4096.0,
                  .filter_time = 50ms};
  ASSERT_TRUE(axes.gear(gear, {.velocity = Eigen::VectorXd::Constant(1, 4.0)}));
  ASSERT_TRUE(axes.wait_locked(100s));
  EXPECT_TRUE(axes.locked());
  ASSERT_EQ(daemon_.gears.size(), 1U);
  const motion_gear_t& sent = daemon_.gears[0];
  EXPECT_EQ(sent.leader, "wheel");
  EXPECT_EQ(sent.signal, "position_value");
  EXPECT_EQ(sent.phase, "at");
  EXPECT_EQ(sent.modulo, 4096.0);
  EXPECT_EQ(sent.filter_time, 0.05);
  EXPECT_EQ(sent.numerator, (std::vector<double>{0.5, -2.0}));
  EXPECT_EQ(sent.goals.at(1).position, 3.0);
  EXPECT_EQ(sent.goals.at(1).max_velocity, 4.0);
  ASSERT_TRUE(axes.stop());
  EXPECT_FALSE(axes.locked());
  EXPECT_FALSE(axes.moving());
}

TEST_F(AxesOnABus, NameTheAxisOfADeviceThatLeads) {
  Axes axes = open_enabled({"elbow"});
  ASSERT_TRUE(axes.gear({.leader = "gantry.2"}));
  EXPECT_EQ(daemon_.gears.at(0).leader, "gantry");
  EXPECT_EQ(daemon_.gears.at(0).leader_axis, 2);
  EXPECT_EQ(daemon_.gears.at(0).phase, "here");
  EXPECT_EQ(daemon_.gears.at(0).numerator, std::vector<double>{1.0});
}

TEST_F(AxesOnABus, SayWhyTaktdRefusesAGear) {
  Axes axes = open_enabled();
  daemon_.refuses = "its leader 'wheel' is no node of the bus";
  const Obstacle why = obstacle_of(axes.gear({.leader = "wheel"}));
  EXPECT_EQ(why.kind, Kind::refused);
  EXPECT_THAT(why.text, HasSubstr("is no node of the bus"));
  EXPECT_EQ(obstacle_of(axes.gear({.leader = "wheel", .ratio = Eigen::Vector3d{1, 2, 3}})).kind,
            Kind::wrong_use);
}

TEST_F(AxesOnABus, StayAliveWhileACallWaits) {
  Axes axes = open_enabled({"shoulder"});
  ASSERT_TRUE(axes.jog(Eigen::VectorXd::Constant(1, 1.0)));
  const int before = daemon_.signs_of_life;
  ASSERT_TRUE(axes.run(short_time));
  EXPECT_GE(daemon_.signs_of_life, before + 1);
}

TEST_F(AxesOnABus, RepeatTheStopAndRenewNoJogMeanwhile) {
  Axes axes = open_enabled({"shoulder"});
  ASSERT_TRUE(axes.jog(Eigen::VectorXd::Constant(1, 1.0)));
  daemon_.ignored_stops = 3;
  const int before = daemon_.signs_of_life;
  ASSERT_TRUE(axes.stop());
  EXPECT_FALSE(axes.moving());
  EXPECT_EQ(daemon_.drives[0].motion.id, 0) << "taktd itself has no motion left";
  ASSERT_TRUE(axes.run(short_time));
  EXPECT_EQ(daemon_.signs_of_life, before) << "none of them names the axis of the jog";
}

TEST_F(AxesOnABus, StopAnOlderJogIfTheNewOneIsRefused) {
  Axes axes = open_enabled({"shoulder"});
  ASSERT_TRUE(axes.jog(Eigen::VectorXd::Constant(1, 1.0)));
  daemon_.refuses = "the axis would leave its range of positions";
  EXPECT_EQ(obstacle_of(axes.jog(Eigen::VectorXd::Constant(1, -1.0))).kind, Kind::refused);
  EXPECT_EQ(daemon_.drives[0].motion.id, 0);
  EXPECT_EQ(daemon_.commands.back().kind, "stop");
}

TEST_F(AxesOnABus, StopAMotionThatHasNotBegunYet) {
  Axes axes = open_enabled();
  ASSERT_TRUE(axes.begin_move(Eigen::Vector2d{50.0, 50.0}));
  ASSERT_TRUE(axes.stop());
  EXPECT_EQ(daemon_.commands.back().kind, "stop");
  EXPECT_FALSE(axes.moving());
}

TEST_F(AxesOnABus, AreNotMovedByAProgramThatHasNotEnabledThem) {
  daemon_.drives[0].statusword = daemon_.drives[1].statusword = 0x0237;
  daemon_.active = true;
  Axes axes = open();
  const Obstacle why = obstacle_of(axes.jog(Eigen::Vector2d{1.0, 1.0}));
  EXPECT_EQ(why.kind, Kind::blocked);
  EXPECT_THAT(why.text, HasSubstr("call enable() first"));
  EXPECT_TRUE(daemon_.commands.empty());
}

TEST_F(AxesOnABus, CommandNothingAfterARestartOfTaktd) {
  Axes axes = open_enabled();
  daemon_.session = 78;
  EXPECT_EQ(obstacle_of(axes.run(100s)).kind, Kind::restarted);
  const std::size_t before = daemon_.commands.size();
  EXPECT_EQ(obstacle_of(axes.enable()).kind, Kind::restarted);
  EXPECT_EQ(obstacle_of(axes.begin_move(Eigen::Vector2d{1.0, 1.0})).kind, Kind::restarted);
  EXPECT_EQ(obstacle_of(axes.set_mode(DriveMode::cyclic_velocity)).kind, Kind::restarted);
  EXPECT_EQ(daemon_.commands.size(), before);
  EXPECT_EQ(axes.positions(), Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(axes.name(1), "elbow");
}

TEST_F(AxesOnABus, SayWhyTaktdRefusesAMotion) {
  Axes axes = open_enabled();
  daemon_.refuses = "the axis would leave its range of positions";
  const Obstacle why = obstacle_of(axes.move(Eigen::Vector2d{200.0, 0.0}));
  EXPECT_EQ(why.kind, Kind::refused);
  EXPECT_THAT(why.text, HasSubstr("the axis would leave its range of positions"));
}

TEST_F(AxesOnABus, SayWhichDriveHasStoppedAMotionAndItsError) {
  daemon_.last_emcy = 0x7305;
  Axes axes = open_enabled();
  daemon_.each_cycle = [](MotionDaemon& daemon) {
    if (daemon.drives[0].position > 1.0) daemon.drives[0].statusword = 0x0218;
  };
  const Obstacle why = obstacle_of(axes.move(Eigen::Vector2d{5.0, 5.0}));
  EXPECT_EQ(why.kind, Kind::stopped);
  EXPECT_THAT(why.text, AllOf(HasSubstr("the drive is in fault"),
                              HasSubstr("bit 3 (fault) of its statusword 0x0218 is 1"),
                              HasSubstr("0x7305 (")));
}

TEST_F(AxesOnABus, AreNotEnabledInAFaultBeforeItsReset) {
  daemon_.drives[1].statusword = 0x0218;
  Axes axes = open();
  const Obstacle why = obstacle_of(axes.enable());
  EXPECT_EQ(why.kind, Kind::blocked);
  EXPECT_THAT(why.text, HasSubstr("elbow: not enabled, fault: bit 3 (fault)"));
  ASSERT_TRUE(axes.reset());
  EXPECT_TRUE(axes.enable());
}

TEST_F(AxesOnABus, ResetAFaultAndLeaveTheOtherDrivesAsTheyAre) {
  daemon_.drives[0] = {.statusword = 0x0237, .controlword = 0x0F};
  daemon_.drives[1].statusword = 0x0218;
  Axes axes = open();
  ASSERT_TRUE(axes.reset());
  EXPECT_EQ(daemon_.drives[1].statusword, 0x0250);
  EXPECT_EQ(daemon_.drives[0].controlword, 0x0F);
  EXPECT_EQ(daemon_.releases, 1) << "the nodes are free again";
}

TEST_F(AxesOnABus, NameTheBitThatKeepsADriveFromBeingEnabled) {
  daemon_.each_cycle = [](MotionDaemon& daemon) { daemon.drives[0].statusword = 0x0240; };
  Axes axes = open({"shoulder"}, short_time);
  const Obstacle why = obstacle_of(axes.enable());
  EXPECT_EQ(why.kind, Kind::blocked);
  EXPECT_THAT(why.text,
              AllOf(HasSubstr("shoulder: not enabled, switch on disabled: bit 6 (switch on "
                              "disabled) of its statusword 0x0240 is 1"),
                    HasSubstr("bit 4 (voltage enabled) is 0")));
}

TEST_F(AxesOnABus, SayThatTaktdRunsNoMotions) {
  daemon_.has_motions = false;
  Axes axes = open();
  EXPECT_THAT(obstacle_of(axes.enable()).text, HasSubstr("it was started with --no-motions"));
}

TEST_F(AxesOnABus, NameTheProgramThatHoldsThem) {
  daemon_.holder = "another";
  Axes axes = open();
  EXPECT_THAT(obstacle_of(axes.enable()).text, HasSubstr("shoulder belongs to 'another'"));
}

TEST_F(AxesOnABus, AreDisabledAndGivenUpAtTheEnd) {
  {
    Axes axes = open_enabled();
  }
  EXPECT_EQ(daemon_.drives[0].statusword, 0x0250);
  EXPECT_EQ(daemon_.drives[1].statusword, 0x0250);
  EXPECT_EQ(daemon_.releases, 1);
}

TEST_F(AxesOnABus, AreNotMovedBeforeTheyAreEnabled) {
  Axes axes = open();
  EXPECT_EQ(obstacle_of(axes.move(Eigen::Vector2d{1.0, 1.0})).kind, Kind::blocked);
  EXPECT_TRUE(daemon_.commands.empty());
}

TEST_F(AxesOnABus, WantOneValueForEachAxis) {
  Axes axes = open_enabled();
  EXPECT_EQ(obstacle_of(axes.move(Eigen::Vector3d{1.0, 1.0, 1.0})).kind, Kind::wrong_use);
  EXPECT_EQ(obstacle_of(axes.move_by(Eigen::VectorXd::Constant(1, 1.0))).kind, Kind::wrong_use);
  EXPECT_TRUE(daemon_.commands.empty());
}

TEST(AxesWithAWrongName, SayWhichAxesThereAre) {
  MotionDaemon daemon;
  const auto axes = Axes::open(std::make_unique<MotionDaemonTransport>(daemon),
                               {.bus = "lift", .names = {"wrist"}, .longest = 100s});
  ASSERT_FALSE(axes);
  EXPECT_EQ(axes.error().kind, Kind::wrong_use);
  EXPECT_THAT(axes.error().text,
              HasSubstr("'wrist', or it is named twice; the axes are: shoulder, elbow"));
}

TEST(AxesWithAWrongTimeout, AreNotOpened) {
  MotionDaemon daemon;
  for (const auto timeout : {0ms, 10'001ms}) {
    const auto axes = Axes::open(std::make_unique<MotionDaemonTransport>(daemon),
                                 {.bus = "lift", .longest = 100s, .timeout = timeout});
    ASSERT_FALSE(axes);
    EXPECT_EQ(axes.error().kind, Kind::wrong_use);
  }
}

TEST(AxesOfASilentBus, SayThatNoImageComes) {
  MotionDaemon daemon;
  daemon.cyclic = false;
  const auto axes = Axes::open(std::make_unique<MotionDaemonTransport>(daemon),
                               {.bus = "lift", .longest = short_time});
  ASSERT_FALSE(axes);
  EXPECT_EQ(axes.error().kind, Kind::no_bus);
}

}  // namespace
}  // namespace takt
