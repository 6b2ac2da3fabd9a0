#include "test/unit/master/sim/model/servo_drive.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <initializer_list>
#include <ios>
#include <vector>

namespace takt::sim {
namespace {

constexpr double amplitude = 20'000;  // counts: four turns to and fro

/// The set-points of a sine that begins at rest, one each 2 ms; the period is 2 s.
std::int64_t sine(int cycle) {
  return std::llround(amplitude * (1 - std::cos(cycle * 0.002 * std::numbers::pi)));
}

double sine_speed(int cycle) {
  return amplitude * std::numbers::pi * std::sin(cycle * 0.002 * std::numbers::pi);
}

TEST_F(ServoDrive, ReachesTheTargetOfAProfile) {
  enable(1);
  set(0x607A, 5000);
  command(0x001F);

  run(500ms);
  EXPECT_EQ(get(0x6041) & 0x0400, 0);
  run(500ms);
  EXPECT_NEAR(static_cast<double>(get(0x6064)), 5000, 5);
  EXPECT_EQ(get(0x6041) & 0x0400, 0x0400);
}

TEST_F(ServoDrive, FollowsCyclicPositionsWithAnError) {
  enable(8);
  double largest = 0;
  for (int i = 0; i < 2000; ++i) {
    sync(sine(i));
    largest = std::max(largest, std::abs(static_cast<double>(get(0x60F4))));
  }

  const double speed = amplitude * std::numbers::pi;
  EXPECT_NEAR(largest, speed / servo_mechanics().controller.position_gain, 0.1 * largest);
  EXPECT_EQ(state(), 0x0237);
}

TEST_F(ServoDrive, FollowsThemWithoutErrorIfTheirVelocityIsFedForward) {
  enable(8);
  double largest = 0;
  for (int i = 0; i < 2000; ++i) {
    set(0x60B1, std::llround(sine_speed(i)));
    sync(sine(i));
    largest = std::max(largest, std::abs(static_cast<double>(get(0x60F4))));
  }

  EXPECT_LT(largest, 200);  // 2 ms at full speed are 126 counts
}

// The reaction of a drive to unsuitable set-points.

TEST_F(ServoDrive, SaturatesItsTorqueAndFaultsAtAStepOfTheTarget) {
  set(0x6065, 2000);
  set(0x6066, 10);
  set(0x6085, 40'000'000);
  enable(8);
  for (int i = 0; i < 10; ++i) sync(0);

  std::int64_t most = 0;
  bool limited = false;
  for (int i = 0; i < 20; ++i) {
    sync(30'000);
    most = std::max(most, get(0x6077));
    limited = limited || (get(0x6041) & 0x0800) != 0;
  }
  run(500ms);

  EXPECT_NEAR(static_cast<double>(most), 3000, 5);
  EXPECT_TRUE(limited);
  EXPECT_EQ(get(0x603F), 0x8611);
  EXPECT_EQ(get(0x6041) & 0x006F, 0x0008);
  EXPECT_EQ(get(0x606C), 0);
  EXPECT_LT(get(0x6064), 20'000) << "it stopped on the way";
}

/// Returns the largest change of the torque between two cycles, in 0.1 %, while a drive follows the
/// sine of a master that repeats each 50th set-point.
class Repetition : public ServoDrive {
 protected:
  std::int64_t roughness(bool repeats) {
    enable(8);
    std::int64_t before = 0;
    std::int64_t largest = 0;
    for (int i = 0; i < 1000; ++i) {
      sync(repeats && i % 50 == 0 ? sine(i - 1) : sine(i));
      const std::int64_t torque = get(0x6077);
      if (i > 10) largest = std::max(largest, std::abs(torque - before));
      before = torque;
    }
    return largest;
  }
};

TEST_F(Repetition, OfNoSetPointLeavesTheTorqueSmooth) { EXPECT_LT(roughness(false), 30); }

TEST_F(Repetition, OfASetPointMakesTheTorqueJump) { EXPECT_GT(roughness(true), 300); }

TEST_F(ServoDrive, AcceleratesByTheTargetTorque) {
  enable(10);
  set(0x6071, 500);
  run(100ms);

  const double torque = 0.5 * 1.27 - 0.04;  // without dry friction
  EXPECT_NEAR(static_cast<double>(get(0x606C)), acceleration(torque) * 0.1,
              0.05 * acceleration(torque) * 0.1);
  EXPECT_EQ(get(0x6077), 500);
  EXPECT_EQ(get(0x6078), 500);
}

TEST_F(ServoDrive, ChangesTheTorqueOfAProfileByItsSlope) {
  set(0x6087, 2000);  // twice the rated torque in one second
  set(0x6502, 0x3AD | 1 << 3);
  enable(4);
  set(0x6071, 200);

  run(50ms);
  EXPECT_NEAR(static_cast<double>(get(0x6077)), 100, 3);
  run(100ms);
  EXPECT_EQ(get(0x6077), 200);
}

TEST_F(ServoDrive, AddsTheTorqueOffsetInCyclicPosition) {
  enable(8);
  sync(0);
  set(0x60B2, 100);
  run(1ms);

  EXPECT_GT(get(0x6074), 50) << "before the controllers answer";
}

TEST_F(ServoDrive, KeepsEachLimitOfItsTorque) {
  for (const std::uint16_t limit : std::initializer_list<std::uint16_t>{0x6072, 0x6073, 0x60E0}) {
    set(limit, 400);
    enable(10);
    set(0x6071, 900);
    run(20ms);
    EXPECT_EQ(get(0x6077), 400) << std::hex << limit;
    EXPECT_EQ(get(0x6041) & 0x0800, 0x0800);
    set(limit, 3000);
  }
  set(0x60E1, 300);
  set(0x6071, -900);
  run(20ms);
  EXPECT_EQ(get(0x6077), -300);
}

TEST_F(ServoDrive, ReachesATargetVelocity) {
  for (const int mode : {3, 9}) {
    enable(mode);
    set(0x60FF, 40'000);
    command(0x000F);
    run(1s);
    EXPECT_NEAR(static_cast<double>(get(0x606C)), 40'000, 400) << mode;
    set(0x60FF, 0);
    run(1s);
    EXPECT_EQ(get(0x606C), 0);
  }
}

TEST_F(ServoDrive, StopsQuicklyOnItsRamp) {
  enable(9);
  set(0x60FF, 100'000);
  run(1s);
  std::int64_t most = 0;

  command(0x000B);
  for (int i = 0; i < 100; ++i) {
    run(1ms);
    most = std::max(most, std::abs(get(0x6077)));
  }
  // 0x6085 is 400,000 counts/s2; the position controller follows 12.5 ms later.
  EXPECT_NEAR(static_cast<double>(get(0x606C)), 65'000, 1'000);
  EXPECT_LT(most, 300) << "the stop doesn't begin with a jolt";
  run(500ms);
  EXPECT_EQ(state(), 0x0250);
}

TEST_F(ServoDrive, ChangesTheModeInMotionWithoutAJolt) {
  enable(9);
  set(0x60FF, 50'000);
  run(1s);
  const std::int64_t before = get(0x6077);

  set(0x6060, 10);
  set(0x6071, before);
  command(0x000F);
  run(2ms);
  EXPECT_NEAR(static_cast<double>(get(0x6077)), static_cast<double>(before), 10);
  EXPECT_NEAR(static_cast<double>(get(0x606C)), 50'000, 500);
}

TEST_F(ServoDrive, CoastsWithoutPower) {
  enable(9);
  set(0x60FF, 100'000);
  run(1s);

  command(0x0000);
  run(100ms);
  EXPECT_EQ(get(0x6077), 0);
  EXPECT_GT(get(0x606C), 30'000);
  run(10s);
  EXPECT_EQ(get(0x606C), 0);
  EXPECT_EQ(drive_.next_change(), never);
}

TEST_F(ServoDrive, GivesEqualValuesForEqualSetPoints) {
  const auto positions = [] {
    class Again : public ServoDrive {
     public:
      void TestBody() override {}
      std::vector<std::int64_t> positions() {
        enable(8);
        std::vector<std::int64_t> all;
        for (int i = 0; i < 500; ++i) {
          sync(sine(i));
          all.insert(all.end(), {get(0x6064), get(0x606C), get(0x6077)});
        }
        return all;
      }
    };
    return Again{}.positions();
  };

  EXPECT_EQ(positions(), positions());
}

class Lift : public ServoDrive {
 protected:
  static MechanicsTable mechanics() {
    MechanicsTable table = servo_mechanics();
    table.load.torque = -0.4;
    table.brake.torque = 2;
    return table;
  }
  Lift() : ServoDrive{mechanics()} {}
};

TEST_F(Lift, IsEnabledWhenItsBrakeHasOpened) {
  enable(8);
  run(40ms);
  EXPECT_EQ(state(), 0x0233);

  run(20ms);
  EXPECT_EQ(state(), 0x0237);
  run(500ms);
  EXPECT_LT(std::abs(get(0x6064)), 50);
}

TEST_F(Lift, HoldsItsWeightUntilTheBrakeHasClosed) {
  enable(8);
  run(500ms);
  const std::int64_t before = get(0x6064);

  command(0x0006);
  run(5ms);
  EXPECT_LT(get(0x6077), 400);
  EXPECT_GT(get(0x6077), 200);
  run(1s);
  EXPECT_EQ(get(0x6077), 0);
  EXPECT_NEAR(static_cast<double>(get(0x6064)), static_cast<double>(before), 3);
}

}  // namespace
}  // namespace takt::sim
