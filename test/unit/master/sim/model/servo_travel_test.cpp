#include <cmath>
#include <gtest/gtest.h>
#include <initializer_list>
#include <map>

#include "test/unit/master/sim/model/servo_drive.hpp"

namespace takt::sim {
namespace {

// Counts. The pulses of the encoder are at 300 and each turn of 10,000 from there.
constexpr double lowest = -50'000;
constexpr double highest = 50'000;
constexpr double left = 10'000;
constexpr double right = 12'000;

MechanicsTable with_switches() {
  MechanicsTable table = servo_mechanics();
  table.travel = {.switches = ZoneParameters{lowest, highest},
                  .home = ZoneParameters{left, right},
                  .probe_1 = ZoneParameters{20'000, 25'000},
                  .index = 300};
  return table;
}

class Travel : public ServoDrive {
 protected:
  explicit Travel(const MechanicsTable& table = with_switches()) : ServoDrive{table} {
    set(0x6081, 100'000);
    set(0x6083, 2'000'000);
    set(0x6084, 2'000'000);
    set(0x6085, 4'000'000);
    set(0x6099, 50'000, 1);
    set(0x6099, 5'000, 2);
    set(0x609A, 2'000'000);
  }

  void go_to(std::int64_t position) {
    enable(1);
    set(0x607A, position);
    command(0x001F);
    run(2s);
    command(0x000F);
  }
  /// Runs a homing until it has ended. Returns bits 10, 12 and 13 of the statusword.
  std::int64_t home(int method) {
    set(0x6098, method);
    enable(6);
    command(0x001F);
    for (int i = 0; i < 300; ++i) {
      run(100ms);
      const std::int64_t bits = get(0x6041) & 0x3400;
      if (bits == 0x1400 || bits == 0x2400) return bits;
    }
    return get(0x6041) & 0x3400;
  }
  /// The position before homing that now reads 0.
  double reference() {
    const double increments = MechanicsTable{}.encoder.increments / counts_a_turn;
    return static_cast<double>(get(0x6063)) / increments - static_cast<double>(get(0x6064));
  }
};

TEST_F(Travel, FindsTheReferenceOfEachMethodFromAnywhere) {
  const std::map<int, double> references{
      {1, -49'700}, {2, 40'300}, {3, 300},     {4, 10'300},   {5, 20'300},  {6, 10'300},
      {7, 300},     {8, 10'300}, {9, 10'300},  {10, 20'300},  {11, 20'300}, {12, 10'300},
      {13, 10'300}, {14, 300},   {17, lowest}, {18, highest}, {19, left},   {20, left},
      {21, right},  {22, right}, {23, left},   {24, left},    {25, right},  {26, right},
      {27, right},  {28, right}, {29, left},   {30, left}};
  for (const auto& [method, expected] : references) {
    for (const std::int64_t start : {-30'000, 11'000, 30'000}) {
      home(35);
      const double origin = reference();
      go_to(start - std::llround(origin));
      EXPECT_EQ(home(method), 0x1400) << method << " from " << start;
      EXPECT_NEAR(reference(), expected, 2) << method << " from " << start;
    }
  }
}

TEST_F(Travel, FindsTheNextIndexPulseInADirection) {
  go_to(4'000);
  EXPECT_EQ(home(33), 0x1400);
  EXPECT_NEAR(reference(), 300, 1);
  go_to(1'000);
  EXPECT_EQ(home(34), 0x1400);
  EXPECT_NEAR(reference(), 10'300, 1);
}

TEST_F(Travel, KeepsTheHomeOffset) {
  set(0x607C, 700);
  EXPECT_EQ(home(19), 0x1400);

  EXPECT_NEAR(reference(), left + 700, 2) << "the reference reads -700";
}

class NoHome : public Travel {
 protected:
  static MechanicsTable table() {
    MechanicsTable table = with_switches();
    table.travel.home = ZoneParameters{80'000, 90'000};  // behind the limit switch
    return table;
  }
  NoHome() : Travel{table()} {}
};

TEST_F(NoHome, FailsBetweenTheLimitSwitches) {
  EXPECT_EQ(home(7), 0x2400);
  EXPECT_LT(std::abs(get(0x6064)), 60'000);
}

TEST_F(Travel, StopsAtItsLimitSwitchAndGoesBack) {
  go_to(40'000);
  enable(9);
  set(0x60FF, 50'000);
  run(1s);

  EXPECT_EQ(get(0x60FD) & 3, 2);
  EXPECT_EQ(get(0x606C), 0);
  EXPECT_LT(get(0x6064), 51'500);
  EXPECT_EQ(get(0x6041) & 0x1800, 0x0800) << "limit active, does not follow";
  EXPECT_EQ(state(), 0x0237);

  set(0x60FF, -50'000);
  run(500ms);
  EXPECT_LT(get(0x606C), -40'000);
  EXPECT_EQ(get(0x60FD) & 3, 0);
  EXPECT_EQ(get(0x6041) & 0x1800, 0x1000);
}

TEST_F(Travel, StopsACyclicPositionAtItsLimitSwitch) {
  go_to(40'000);
  set(0x607A, get(0x6064));
  enable(8);
  const std::int64_t start = get(0x6064);
  for (int i = 0; i < 600; ++i) sync(start + i * 50);

  EXPECT_EQ(get(0x606C), 0);
  EXPECT_LT(get(0x6064), 51'500);
  EXPECT_EQ(get(0x6041) & 0x1800, 0x0800);

  for (int i = 600; i >= 0; --i) sync(start + i * 50);
  EXPECT_NEAR(static_cast<double>(get(0x6064)), static_cast<double>(start), 500);
}

TEST_F(Travel, StopsATorqueAtItsSoftwareLimit) {
  set(0x607D, -20'000, 1);
  set(0x607D, 20'000, 2);
  enable(10);
  set(0x6071, 200);
  run(2s);

  EXPECT_EQ(get(0x606C), 0);
  EXPECT_LT(get(0x6064), 60'000);
}

class HardStops : public Travel {
 protected:
  static MechanicsTable table() {
    MechanicsTable table = servo_mechanics();
    table.travel.stops = ZoneParameters{-1000, 2000};
    return table;
  }
  HardStops() : Travel{table()} {}
};

TEST_F(HardStops, EndTheMotionWithAFollowingError) {
  set(0x6065, 500);
  set(0x6066, 20);
  enable(1);
  set(0x607A, 8000);
  command(0x001F);
  run(500ms);

  EXPECT_EQ(get(0x603F), 0x8611);
  EXPECT_NEAR(static_cast<double>(get(0x6064)), 2000, 2);
}

class TouchProbeDrive : public Drive {
 protected:
  static SampleDevice device() {
    using enum DataType;
    SampleDevice device = servo_drive(5_node);
    device.object(0x60B8, 0, unsigned16, Access::rw, 0)
        .object(0x60B9, 0, unsigned16, Access::ro, 0)
        .object(0x60BA, 0, integer32, Access::ro, 0)
        .object(0x60BB, 0, integer32, Access::ro, 0);
    return device;
  }
  static const MechanicsTable* mechanics() {
    static const MechanicsTable table = with_switches();
    return &table;
  }
  TouchProbeDrive() : Drive{device(), mechanics()} {
    set(0x6081, 50'000);
    enable(1);
  }
  void go_to(std::int64_t position) {
    set(0x607A, position);
    command(0x003F);
    run(2s);
    command(0x000F);
  }
};

TEST_F(TouchProbeDrive, LatchesThePositionsOfBothEdges) {
  set(0x60B8, 0x31);
  go_to(22'000);
  EXPECT_EQ(get(0x60B9), 0x03);
  EXPECT_NEAR(static_cast<double>(get(0x60BA)), 20'000, 2);
  EXPECT_EQ(get(0x60FD), 0x10000);

  go_to(30'000);
  EXPECT_EQ(get(0x60B9), 0x07);
  EXPECT_NEAR(static_cast<double>(get(0x60BB)), 25'000, 2);
}

TEST_F(TouchProbeDrive, LatchesOnceUnlessContinuous) {
  set(0x60B8, 0x11);
  go_to(30'000);
  go_to(0);
  EXPECT_NEAR(static_cast<double>(get(0x60BA)), 20'000, 2);

  set(0x60B8, 0x13);
  go_to(30'000);
  EXPECT_NEAR(static_cast<double>(get(0x60BA)), 20'000, 2);
  go_to(0);
  EXPECT_NEAR(static_cast<double>(get(0x60BA)), 25'000, 2);
}

TEST_F(TouchProbeDrive, LatchesTheIndexPulse) {
  set(0x60B8, 0x15);
  go_to(5'000);

  EXPECT_EQ(get(0x60B9), 0x03);
  EXPECT_EQ(get(0x60BA), 300);
}

TEST_F(TouchProbeDrive, ForgetsWhenItIsDisabled) {
  set(0x60B8, 0x11);
  go_to(22'000);
  set(0x60B8, 0);
  run(2ms);

  EXPECT_EQ(get(0x60B9), 0);
}

}  // namespace
}  // namespace takt::sim
