#include "master/sim/mechanics/servo.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace takt::sim {
namespace {

using namespace std::chrono_literals;

constexpr double turn = 65536;

MechanicsTable table() {
  MechanicsTable table;
  table.turn = turn;
  return table;
}

constexpr ServoLimits free_limits{.torque = {.positive = 3.81, .negative = 3.81}, .speed = 628};

class ServoAxis : public testing::Test {
 protected:
  explicit ServoAxis(const MechanicsTable& parameters = table()) : servo_{parameters} {
    servo_.reset(Time{});
  }

  void run(const ServoReference& reference, Time span) {
    for (const Time end = now_ + span; now_ < end;) {
      now_ += 1ms;
      servo_.run(reference, limits_, now_);
    }
  }
  void move_to(double position, Time span) {
    run({.loop = ServoLoop::position, .position = position}, span);
  }

  Servo servo_;
  ServoLimits limits_ = free_limits;
  Time now_{};
};

TEST_F(ServoAxis, GoesToItsSetPointAndRestsThere) {
  move_to(2000, 300ms);
  EXPECT_NEAR(servo_.position(), 2000, 1);
  const double rest = servo_.position();
  for (int i = 0; i < 1000; ++i) {
    move_to(2000, 1ms);
    ASSERT_EQ(servo_.position(), rest);
  }
  EXPECT_EQ(servo_.velocity(), 0);
}

TEST_F(ServoAxis, FollowsARampWithTheErrorOfItsPositionGain) {
  for (int i = 1; i <= 1000; ++i) {
    servo_.run({.loop = ServoLoop::position, .position = i * 500.0, .velocity = 500'000}, limits_,
               now_ += 1ms);
  }

  EXPECT_NEAR(500'000 - servo_.position(), servo_.lead(500'000), 100);
  EXPECT_NEAR(servo_.lead(500'000), 6'250, 1);
  EXPECT_NEAR(servo_.velocity(), 500'000, 500);
}

TEST_F(ServoAxis, FollowsARampWithoutErrorIfTheMasterFeedsItsVelocityForward) {
  for (int i = 1; i <= 1000; ++i) {
    servo_.run({.loop = ServoLoop::position, .position = i * 500.0, .velocity_add = 500'000},
               limits_, now_ += 1ms);
  }

  EXPECT_NEAR(servo_.position(), 500'000, 100);
}

TEST_F(ServoAxis, ReachesAVelocityWithoutSwinging) {
  double fastest = 0;
  for (int i = 0; i < 500; ++i) {
    run({.loop = ServoLoop::velocity, .velocity = 100'000}, 1ms);
    fastest = std::max(fastest, servo_.velocity());
  }

  EXPECT_NEAR(servo_.velocity(), 100'000, 600);
  EXPECT_LT(fastest, 150'000);
}

TEST_F(ServoAxis, KeepsItsTorqueWithinTheLimits) {
  limits_.torque = {.positive = 0.5, .negative = 0.25};
  int limited = 0;
  for (int i = 0; i < 500; ++i) {
    move_to(i < 250 ? turn : -turn, 1ms);
    ASSERT_LE(servo_.torque(), 0.5);
    ASSERT_GE(servo_.torque(), -0.25);
    limited += servo_.limited();
  }
  EXPECT_GT(limited, 100);
}

TEST_F(ServoAxis, IsNotFasterThanItsMotor) {
  run({.loop = ServoLoop::torque, .torque = 3.81}, 2s);

  EXPECT_LT(servo_.velocity(), 628 / (2 * std::numbers::pi) * turn);
  EXPECT_GT(servo_.velocity(), 550 / (2 * std::numbers::pi) * turn);
}

TEST_F(ServoAxis, ReachesItsTorqueWithTheLagOfTheCurrent) {
  run({.loop = ServoLoop::torque, .torque = 1.0}, 1ms);
  EXPECT_GT(servo_.torque(), 0.95);
  EXPECT_LT(servo_.torque(), 1.0);
  run({.loop = ServoLoop::off}, 1ms);
  EXPECT_EQ(servo_.torque(), 0);
}

TEST_F(ServoAxis, DoesNotDependOnHowOftenItIsCalled) {
  Servo other{table()};
  other.reset(Time{});
  const ServoReference reference{.loop = ServoLoop::velocity, .velocity = 12'345};
  for (int i = 0; i < 1000; ++i) {
    servo_.run(reference, limits_, now_ += 4ms);
    for (int part = 0; part < 7; ++part) other.run(reference, limits_, now_ - 4ms + part * 571us);
    other.run(reference, limits_, now_);
    ASSERT_EQ(servo_.position(), other.position());
  }
}

TEST_F(ServoAxis, ReportsPositionsBetweenTwoTicks) {
  run({.loop = ServoLoop::velocity, .velocity = 800'000}, 1s);
  const double before = servo_.reported(now_);

  servo_.run({.loop = ServoLoop::velocity, .velocity = 800'000}, limits_, now_ += 100us);
  EXPECT_NEAR(servo_.reported(now_) - before, 80, 2);
}

class Sticky : public ServoAxis {
 protected:
  static MechanicsTable parameters() {
    MechanicsTable sticky = table();
    sticky.motor.breakaway = sticky.load.breakaway = 1.3;
    return sticky;
  }
  Sticky() : ServoAxis{parameters()} {}
};

TEST_F(Sticky, HuntsForItsTarget) {
  move_to(2000, 2s);
  double low = servo_.position();
  double high = low;
  for (int i = 0; i < 2000; ++i) {
    move_to(2000, 1ms);
    low = std::min(low, servo_.position());
    high = std::max(high, servo_.position());
  }

  EXPECT_GT(high - low, 4);
  EXPECT_LT(high - low, 40);
}

class SlowEncoder : public ServoAxis {
 protected:
  static MechanicsTable parameters() {
    MechanicsTable slow = table();
    slow.encoder = {.increments = 4096, .dead_time = 0.002};
    return slow;
  }
  SlowEncoder() : ServoAxis{parameters()} {}
};

TEST_F(SlowEncoder, ReportsOldPositionsInItsIncrements) {
  run({.loop = ServoLoop::velocity, .velocity = 800'000}, 1s);
  const double now = servo_.position();

  EXPECT_NEAR(now - servo_.reported(now_), 1600, 150);
  EXPECT_NEAR(std::remainder(servo_.reported(now_), 16), 0, 1e-6);
}

class Vertical : public ServoAxis {
 protected:
  static MechanicsTable parameters() {
    MechanicsTable heavy = table();
    heavy.load.torque = -0.4;
    heavy.brake = {.torque = 2.0, .opening = 0.05, .closing = 0.04};
    return heavy;
  }
  Vertical() : ServoAxis{parameters()} {}
};

TEST_F(Vertical, IsHeldByItsBrakeUntilTheDriveHoldsIt) {
  run({.loop = ServoLoop::off}, 1s);
  EXPECT_EQ(servo_.position(), 0);
  EXPECT_FALSE(servo_.released());

  run({.loop = ServoLoop::hold}, 49ms);
  EXPECT_FALSE(servo_.released());
  run({.loop = ServoLoop::hold}, 200ms);
  EXPECT_TRUE(servo_.released());
  EXPECT_NEAR(servo_.position(), 0, 300) << "it sags until the integral holds the weight";
  EXPECT_NEAR(servo_.torque(), 0.4, 0.1);
}

TEST_F(Vertical, IsHeldByTheDriveUntilTheBrakeHasClosed) {
  run({.loop = ServoLoop::hold}, 500ms);
  const double before = servo_.position();

  run({.loop = ServoLoop::off}, 1s);
  EXPECT_NEAR(servo_.position(), before, 2);
  EXPECT_TRUE(servo_.rests());
}

TEST_F(Vertical, FallsUntilTheBrakeHasClosedIfItLosesPowerInMotion) {
  run({.loop = ServoLoop::hold}, 500ms);
  run({.loop = ServoLoop::velocity, .velocity = -65'536}, 200ms);
  const double before = servo_.position();

  run({.loop = ServoLoop::off}, 1s);
  EXPECT_LT(servo_.position(), before - 3000);
  EXPECT_TRUE(servo_.rests());
}

}  // namespace
}  // namespace takt::sim
