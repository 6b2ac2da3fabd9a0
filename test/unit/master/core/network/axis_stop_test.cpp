#include "master/core/network/axis_stop.hpp"

#include <gtest/gtest.h>

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t operation_enabled = 0x0237;
constexpr std::int64_t switch_on_disabled = 0x0250;

/// A value of 606C comes every 100 ms. The axis stops within 10 ms and disables itself.
class RareVelocity : public testing::Test {
 protected:
  void SetUp() override {
    axis.begin(now, AxisPrior::exposed);
    for (int i = 0; i < 20; ++i)
      step({.statusword = operation_enabled, .velocity = 8000, .position = {}});
    for (int i = 0; i < 45; ++i)
      step({.statusword = switch_on_disabled, .velocity = {}, .position = {}});
  }
  void step(const AxisSample& sample) { axis.step(now += 2ms, sample); }
  void velocities(std::int64_t velocity, int count) {
    for (int i = 0; i < count; ++i) {
      step({.statusword = switch_on_disabled, .velocity = velocity, .position = {}});
      for (int k = 1; k < 50; ++k)
        step({.statusword = switch_on_disabled, .velocity = {}, .position = {}});
    }
  }

  AxisStop axis;
  Time now = 1s;
};

TEST_F(RareVelocity, IsAwaited) {
  EXPECT_EQ(axis.state(), AxisState::settling) << "90 ms after the last velocity";
  velocities(0, 2);
  EXPECT_EQ(axis.state(), AxisState::settling) << "two values are too few";
  velocities(0, 1);
  EXPECT_EQ(axis.state(), AxisState::stopped);
}

TEST_F(RareVelocity, ShowsThatTheAxisCoasts) {
  velocities(7000, 1);
  EXPECT_EQ(axis.state(), AxisState::dropped);
  EXPECT_EQ(axis.velocity(), 8000);
}

TEST(AxisStop, DoesNotConfirmAFaultWhileTheAxisMoves) {
  constexpr std::int64_t fault = 0x0218;
  for (const std::int64_t velocity : {8000, 0}) {
    AxisStop axis;
    axis.begin(1s, AxisPrior::exposed);
    axis.step(1002ms, {.statusword = operation_enabled, .velocity = velocity, .position = {}});
    Time now = 1002ms;
    for (int i = 0; i < 40; ++i) {
      axis.step(now += 2ms, {.statusword = fault, .velocity = 0, .position = {}});
    }
    EXPECT_EQ(axis.state(), velocity == 0 ? AxisState::stopped : AxisState::dropped);
    EXPECT_EQ(axis.velocity(), velocity);
  }
}

TEST(AxisStop, DoesNotCountAVelocityAfterTheNewestEnabledStatusword) {
  AxisStop axis{AxisPlan{.quick_stop_option = 0}};
  Time now = 1s;
  axis.begin(now, AxisPrior::exposed);
  axis.step(now += 2ms, {.statusword = operation_enabled, .velocity = 8000, .position = {}});
  for (int i = 0; i < 40; ++i) {
    axis.step(now += 2ms, {.statusword = {}, .velocity = 0, .position = {}});
  }
  axis.step(now += 2ms, {.statusword = switch_on_disabled, .velocity = 0, .position = {}});
  EXPECT_EQ(axis.state(), AxisState::dropped) << "the statusword was late";
  EXPECT_EQ(axis.velocity(), 8000);
}

TEST(AxisStop, IsConfirmedWhereTheAxisWasDisabledBeforeTheStop) {
  AxisStop axis{AxisPlan{.quick_stop_option = 0}};
  Time now = 1s;
  axis.begin(now, AxisPrior::exposed);
  axis.note_command();
  axis.recall(switch_on_disabled, std::nullopt);
  for (int i = 0; i < 40; ++i) {
    axis.step(now += 2ms, {.statusword = switch_on_disabled, .velocity = 0, .position = {}});
  }
  EXPECT_EQ(axis.state(), AxisState::stopped);
}

/// An axis that disables itself at the end of its ramp. Its velocity is read by SDO, and the
/// answers come 300 ms after the requests.
class LateVelocity : public testing::Test {
 protected:
  void SetUp() override {
    axis.begin(now, AxisPrior::exposed);
    axis.step(now, {.statusword = operation_enabled, .velocity = {}, .position = {}});
    now += 100ms;
    axis.step(now, {.statusword = switch_on_disabled, .velocity = {}, .position = {}});
  }
  void answer(Time asked, std::int64_t velocity) {
    now = asked + 300ms;
    axis.step(now, {.statusword = switch_on_disabled,
                    .velocity = velocity,
                    .position = {},
                    .motion_asked = asked});
  }

  AxisStop axis;
  Time now = 1s;
};

TEST_F(LateVelocity, IsThatOfTheTimeOfItsRequest) {
  answer(1090ms, 4000);
  EXPECT_EQ(axis.state(), AxisState::settling) << "requested before the axis disabled itself";
  answer(1400ms, 0);
  answer(1710ms, 0);
  answer(2020ms, 0);
  EXPECT_EQ(axis.state(), AxisState::stopped);
}

TEST_F(LateVelocity, ShowsThatTheAxisCoasts) {
  answer(1120ms, 4000);
  EXPECT_EQ(axis.state(), AxisState::settling) << "the end of the ramp may still show";
  answer(1450ms, 4000);
  EXPECT_EQ(axis.state(), AxisState::dropped);
}

TEST(AxisStop, JudgesByThePositionWhereNoVelocityComes) {
  AxisStop axis;
  Time now = 1s;
  axis.begin(now, AxisPrior::exposed);
  axis.step(now, {.statusword = operation_enabled, .velocity = 8000, .position = {}});
  for (int i = 0; i < 24; ++i) {
    axis.step(now += 2ms, {.statusword = operation_enabled, .velocity = {}, .position = 5});
    ASSERT_FALSE(axis.by_position()) << "the velocity is new enough";
  }
  for (int i = 0; i < 30; ++i) {
    axis.step(now += 2ms, {.statusword = operation_enabled, .velocity = {}, .position = 5});
  }
  EXPECT_TRUE(axis.by_position());
  EXPECT_EQ(axis.state(), AxisState::standing);
}

/// The axis moves one count in 2 ms. Frames that waited in the device come after a pause of 62 ms.
TEST(AxisStop, DoesNotCountAPauseOfTheBusAsRest) {
  AxisStop axis;
  Time now = 1s;
  axis.begin(now, AxisPrior::exposed);
  const auto frame = [&](std::int64_t position) {
    axis.step(now += 2ms, {.statusword = operation_enabled, .velocity = {}, .position = position});
  };
  for (std::int64_t i = 0; i < 24; ++i) frame(i);
  now += 60ms;
  for (std::int64_t i = 24; i < 28; ++i) {
    frame(i);
    EXPECT_EQ(axis.state(), AxisState::braking) << i;
  }
  for (int i = 0; i < 26; ++i) frame(27);
  EXPECT_EQ(axis.state(), AxisState::standing) << "50 ms of frames show that it rests";
}

}  // namespace
}  // namespace takt
