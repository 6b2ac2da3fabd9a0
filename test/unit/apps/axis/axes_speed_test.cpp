#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <takt/motion.hpp>
#include <thread>
#include <utility>

#include "test/unit/apps/axis/inverter_daemon.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::InverterDaemon;
using test::InverterTransport;
using ::testing::HasSubstr;
using Kind = Obstacle::Kind;

Eigen::VectorXd one(double value) { return Eigen::VectorXd::Constant(1, value); }

Obstacle obstacle_of(const Done& done) { return done ? Obstacle{.text = "none"} : done.error(); }

class SpeedAxesOnABus : public ::testing::Test {
 protected:
  Axes open(std::vector<std::string> names = {"pump"}, std::chrono::milliseconds timeout = 10s) {
    auto axes =
        Axes::open(std::make_unique<InverterTransport>(daemon_),
                   {.bus = "lift", .names = std::move(names), .longest = 100s, .timeout = timeout});
    EXPECT_TRUE(axes) << axes.error().text;
    return std::move(*axes);
  }
  Axes open_enabled(std::chrono::milliseconds timeout = 10s) {
    Axes axes = open({"pump"}, timeout);
    const Done done = axes.enable();
    EXPECT_TRUE(done) << done.error().text;
    return axes;
  }
  /// Runs until the inverter has this frequency, in 0.01 Hz.
  bool reaches(Axes& axes, std::int64_t frequency) {
    for (int i = 0; i < 10'000 && daemon_.frequency != frequency; ++i) {
      if (!axes.run(1ms)) return false;
    }
    return daemon_.frequency == frequency;
  }

  InverterDaemon daemon_;
};

TEST_F(SpeedAxesOnABus, AreFoundWithAndWithoutTheirNames) {
  EXPECT_FALSE(open().has_positions());
  const Axes axes = open({});
  EXPECT_EQ(axes.size(), 1);
  EXPECT_EQ(axes.name(0), "pump");
  EXPECT_EQ(axes.unit(0), "Hz");
}

TEST_F(SpeedAxesOnABus, RunForwardAndBackwardAndStop) {
  Axes axes = open_enabled();
  ASSERT_TRUE(axes.jog(one(20.0)));
  EXPECT_TRUE(reaches(axes, 2000));
  EXPECT_DOUBLE_EQ(axes.velocities()(0), 20.0);
  EXPECT_TRUE(axes.moving());
  ASSERT_TRUE(axes.jog(one(-5.0)));
  EXPECT_TRUE(reaches(axes, -500));
  EXPECT_DOUBLE_EQ(axes.velocities()(0), -5.0);
  ASSERT_TRUE(axes.stop());
  EXPECT_EQ(daemon_.frequency, 0);
  EXPECT_EQ(daemon_.control, 5);
  EXPECT_FALSE(axes.moving());
  ASSERT_TRUE(axes.disable());
  EXPECT_EQ(daemon_.releases, 1);
}

TEST_F(SpeedAxesOnABus, SayThatTheyHaveNoPosition) {
  Axes axes = open_enabled();
  for (const Done& done : {axes.move(one(1.0)), axes.move_by(one(1.0)), axes.begin_move(one(1.0)),
                           axes.gear({.leader = "encoder"}), axes.set_mode(DriveMode::homing)}) {
    EXPECT_EQ(obstacle_of(done).kind, Kind::wrong_use);
    EXPECT_THAT(obstacle_of(done).text, HasSubstr("pump is a speed axis and has no position"));
  }
}

TEST_F(SpeedAxesOnABus, RefuseSpeedsOutsideTheirLimitsAndTheirWords) {
  Axes axes = open_enabled();
  EXPECT_THAT(obstacle_of(axes.jog(one(51.0))).text, HasSubstr("above the limit of pump, 50 Hz"));
  EXPECT_EQ(obstacle_of(axes.jog(one(700.0))).kind, Kind::wrong_use);
  EXPECT_EQ(obstacle_of(axes.jog(Eigen::Vector2d{1.0, 1.0})).kind, Kind::wrong_use);
  EXPECT_TRUE(daemon_.speeds.empty());
}

TEST_F(SpeedAxesOnABus, NeedToBeEnabled) {
  Axes axes = open();
  EXPECT_THAT(obstacle_of(axes.jog(one(5.0))).text, HasSubstr("call enable() first"));
  EXPECT_EQ(daemon_.commands, 0);
}

TEST_F(SpeedAxesOnABus, ChangeTheirSetSpeedWithinTheAcceleration) {
  daemon_.max_acceleration = 50.0;  // Hz/s: 10 counts in a cycle
  Axes axes = open_enabled();
  ASSERT_TRUE(axes.jog(one(10.0)));
  EXPECT_TRUE(reaches(axes, 1000));
  ASSERT_TRUE(axes.jog(one(-10.0)));
  EXPECT_TRUE(reaches(axes, -1000));
  ASSERT_TRUE(axes.stop());
  ASSERT_GT(daemon_.speeds.size(), 200U);
  for (std::size_t i = 1; i < daemon_.speeds.size(); ++i) {
    // A loaded machine may skip cycles; 50 ms of them count at most.
    EXPECT_LE(std::abs(daemon_.speeds[i] - daemon_.speeds[i - 1]), 251);
  }
}

TEST_F(SpeedAxesOnABus, TellTheirFaultAndResetIt) {
  Axes axes = open_enabled();
  ASSERT_TRUE(axes.jog(one(20.0)));
  daemon_.each_cycle = [](InverterDaemon& daemon) {
    daemon.fault = true;
    daemon.each_cycle = {};
  };
  EXPECT_THAT(obstacle_of(axes.wait()).text,
              HasSubstr("pump has a fault: its status word is 0x0004"));
  EXPECT_EQ(obstacle_of(axes.jog(one(5.0))).kind, Kind::blocked);
  ASSERT_TRUE(axes.reset());
  EXPECT_EQ(daemon_.reset_from, 5) << "the drive sees the change to the command";
  ASSERT_TRUE(axes.enable());
  EXPECT_TRUE(axes.jog(one(5.0)));
}

TEST_F(SpeedAxesOnABus, DoNotRunAgainByThemselvesAfterASilence) {
  Axes axes = open_enabled(2s);
  EXPECT_EQ(daemon_.time_to_live, 1000) << "the timeout in cycles";
  ASSERT_TRUE(axes.jog(one(20.0)));
  std::this_thread::sleep_for(2500ms);
  EXPECT_THAT(obstacle_of(axes.wait()).text, HasSubstr("this program was silent for"));
  EXPECT_EQ(daemon_.control, 5);
  EXPECT_TRUE(reaches(axes, 0));
}

TEST_F(SpeedAxesOnABus, TellThatTaktdHasStoppedThem) {
  Axes axes = open_enabled();
  ASSERT_TRUE(axes.jog(one(20.0)));
  daemon_.fell_back = true;
  EXPECT_EQ(obstacle_of(axes.wait()).text, "pump stops: its commands are too old");
  EXPECT_TRUE(reaches(axes, 0)) << "it does not run again by itself";
  EXPECT_EQ(daemon_.control, 5);
}

TEST_F(SpeedAxesOnABus, DoNotGoOnIfANewRunIsRefused) {
  Axes axes = open_enabled();
  ASSERT_TRUE(axes.jog(one(20.0)));
  EXPECT_EQ(obstacle_of(axes.jog(one(120.0))).kind, Kind::refused);
  EXPECT_TRUE(reaches(axes, 0));
}

TEST_F(SpeedAxesOnABus, SayWhoHoldsThem) {
  daemon_.holder = "another program";
  Axes axes = open();
  EXPECT_THAT(obstacle_of(axes.enable()).text, HasSubstr("pump belongs to 'another program'"));
}

TEST_F(SpeedAxesOnABus, StopWithTheirObject) {
  {
    Axes axes = open_enabled();
    ASSERT_TRUE(axes.jog(one(20.0)));
    EXPECT_TRUE(reaches(axes, 2000));
  }
  EXPECT_EQ(daemon_.frequency, 0);
  EXPECT_EQ(daemon_.releases, 1);
}

}  // namespace
}  // namespace takt
