#include <cmath>
#include <gtest/gtest.h>

#include "test/unit/master/sim/model/drive_fixture.hpp"

namespace takt::sim {
namespace {

TEST_F(Drive, MovesToATargetWithTheHandshake) {
  enable(1);
  set(0x607A, 5000);
  command(0x000F);
  EXPECT_EQ(get(0x6041) & 0x1000, 0);

  command(0x001F);
  EXPECT_EQ(get(0x6041) & 0x1000, 0x1000);
  command(0x000F);
  EXPECT_EQ(get(0x6041) & 0x1400, 0x0000);

  run(300ms);
  EXPECT_GT(get(0x6064), 1000);
  EXPECT_LE(std::abs(get(0x606C)), 10'050);
  EXPECT_EQ(get(0x6041) & 0x0400, 0);

  run(700ms);
  EXPECT_EQ(get(0x6064), 5000);
  EXPECT_EQ(get(0x606C), 0);
  EXPECT_EQ(get(0x6041) & 0x0400, 0x0400);
}

// 5000 units at 10,000/s with ramps of 100,000/s2 take 0.1 + 0.4 + 0.1 s.

TEST_F(Drive, NeedsTheTimeOfItsTrapezoid) {
  enable(1);
  set(0x607A, 5000);
  command(0x001F);

  run(560ms);
  EXPECT_EQ(get(0x6041) & 0x0400, 0);
  run(160ms);
  EXPECT_EQ(get(0x6041) & 0x0400, 0x0400);
}

TEST_F(Drive, KeepsASecondSetPointUntilTheFirstIsReached) {
  enable(1);
  set(0x607A, 1000);
  command(0x001F);
  command(0x000F);
  set(0x607A, -1000);
  command(0x001F);
  command(0x000F);
  EXPECT_EQ(get(0x6041) & 0x1000, 0x1000) << "the buffer is full";

  run(150ms);
  EXPECT_GT(get(0x6064), 500);
  run(800ms);
  EXPECT_EQ(get(0x6064), -1000);
  EXPECT_EQ(get(0x6041) & 0x1000, 0);
}

TEST_F(Drive, ChangesTheTargetAtOnceWithBit5) {
  enable(1);
  set(0x607A, 5000);
  command(0x001F);
  run(100ms);
  command(0x000F);
  set(0x607A, -500);
  command(0x003F);
  command(0x000F);

  run(1500ms);
  EXPECT_EQ(get(0x6064), -500);
}

TEST_F(Drive, MovesRelativeToTheLastTarget) {
  enable(1);
  set(0x607A, 700);
  command(0x005F);
  command(0x000F);
  run(1s);
  command(0x005F);
  run(1s);

  EXPECT_EQ(get(0x6064), 1400);
}

TEST_F(Drive, HaltsAndGoesOn) {
  enable(1);
  set(0x607A, 5000);
  command(0x001F);
  run(200ms);
  command(0x011F);
  run(300ms);
  const std::int64_t halted = get(0x6064);
  EXPECT_LT(halted, 4000);
  EXPECT_EQ(get(0x6041) & 0x0400, 0x0400);

  run(100ms);
  EXPECT_EQ(get(0x6064), halted);
  command(0x001F);
  run(1s);
  EXPECT_EQ(get(0x6064), 5000);
}

TEST_F(Drive, StaysWithinItsSoftwareLimits) {
  set(0x607D, -300, 1);
  set(0x607D, 300, 2);
  enable(1);
  set(0x607A, 5000);
  command(0x001F);
  run(1s);

  EXPECT_EQ(get(0x6064), 300);
  EXPECT_EQ(get(0x6041) & 0x0800, 0x0800);
}

TEST_F(Drive, ReachesItsTargetVelocity) {
  enable(3);
  set(0x60FF, 8000);
  command(0x000F);
  EXPECT_EQ(get(0x6041) & 0x1000, 0x1000) << "still stands";

  run(40ms);
  EXPECT_NEAR(static_cast<double>(get(0x606C)), 4000, 300);
  run(100ms);
  EXPECT_EQ(get(0x606C), 8000);
  EXPECT_EQ(get(0x6041) & 0x1400, 0x0400);
}

TEST_F(Drive, FollowsCyclicPositions) {
  set(0x6065, 200);
  enable(8);
  double worst = 0;
  std::int64_t last = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto target = static_cast<std::int64_t>(20'000 * (1 - std::cos(i * 0.006)));
    sync(target);
    worst = std::max(worst, std::abs(static_cast<double>(get(0x60F4))));
    last = target;
  }
  EXPECT_LT(worst, 30);
  EXPECT_EQ(get(0x6041) & 0x3FFF, 0x1237);
  sync(last);
  for (int i = 0; i < 100; ++i) sync(last);
  EXPECT_EQ(get(0x6064), last);
}

TEST_F(Drive, FollowsCyclicVelocities) {
  enable(9);
  EXPECT_EQ(get(0x6061), 9);

  set(0x60FF, 2'000);
  run(500ms);
  const std::int64_t before = get(0x6064);
  run(100ms);
  EXPECT_NEAR(static_cast<double>(get(0x606C)), 2'000, 20);
  EXPECT_NEAR(static_cast<double>(get(0x6064) - before), 200, 10);

  set(0x60FF, -1'000);
  run(500ms);
  EXPECT_NEAR(static_cast<double>(get(0x606C)), -1'000, 10);
}

TEST_F(Drive, ReportsTorqueOfTheSignOfItsAcceleration) {
  enable(9);
  set(0x60FF, 100'000);
  run(1ms);
  EXPECT_GT(get(0x6077), 100);

  run(50ms);
  const std::int64_t friction = get(0x6077);
  EXPECT_GT(friction, 0);
  EXPECT_LT(friction, 50);

  set(0x60FF, 0);
  run(1ms);
  EXPECT_LT(get(0x6077), -100);
}

TEST_F(Drive, HomesWhereItStandsWithMethod35) {
  set(0x607C, 250);
  enable(6);
  EXPECT_EQ(get(0x6041) & 0x3400, 0x0400);

  command(0x001F);
  run(5ms);
  EXPECT_EQ(get(0x6041) & 0x3400, 0x1400);
  EXPECT_EQ(get(0x6064), -250);
}

TEST_F(Drive, HomesAtASwitchAhead) {
  set(0x6098, 17);
  enable(6);
  command(0x001F);
  run(100ms);
  EXPECT_EQ(get(0x6041) & 0x3400, 0x0000);
  EXPECT_LT(get(0x606C), -4000);

  run(5s);
  EXPECT_EQ(get(0x6041) & 0x3400, 0x1400);
  EXPECT_NEAR(static_cast<double>(get(0x6064)), 0, 10);
}

TEST_F(Drive, ReportsAHomingMethodThatItDoesNotKnow) {
  set(0x6098, 36);
  enable(6);
  command(0x001F);
  run(5ms);

  EXPECT_EQ(get(0x6041) & 0x3400, 0x2400);
}

/// A drive that lists two homing methods (0x60E3).
class DriveWithTwoMethods : public Drive {
 protected:
  DriveWithTwoMethods()
      : Drive{drive(5_node)
                  .object(0x60E3, 0, DataType::unsigned8, Access::constant, 2)
                  .object(0x60E3, 1, DataType::integer8, Access::ro, 18)
                  .object(0x60E3, 2, DataType::integer8, Access::ro, 35)} {}
};

TEST_F(DriveWithTwoMethods, HasNoOther) {
  enable(6);
  command(0x001F);
  run(5ms);
  EXPECT_EQ(get(0x6041) & 0x3400, 0x1400) << "35";
  command(0x000F);
  set(0x6098, 37);
  command(0x001F);
  run(5ms);
  EXPECT_EQ(get(0x6041) & 0x3400, 0x2400) << "37";
}

TEST_F(Drive, StopsHomingWhenBit4Falls) {
  set(0x6098, 18);
  enable(6);
  command(0x001F);
  run(100ms);
  command(0x000F);
  run(200ms);

  EXPECT_EQ(get(0x6041) & 0x3400, 0x0400);
  EXPECT_EQ(get(0x606C), 0);
}

}  // namespace
}  // namespace takt::sim
