// Gears over LCM, from the bytes of motion_gear_t to the simulated drives.
#include <cmath>
#include <gtest/gtest.h>

#include "test/motions/motion_bus.hpp"

namespace takt {
namespace {

using test::MotionBus;
using test::moving;
using test::refused;
using test::standing;
using test::stopped;

constexpr std::int8_t locked = 2;

void move_shoulder(MotionBus& bus, std::int32_t id, double position, double velocity) {
  motion_command_t message = bus.command("move", id);
  message.goals = {MotionBus::goal("shoulder", position)};
  message.goals[0].max_velocity = velocity;
  message.goals[0].max_jerk = 200.0;
  bus.send(message);
}

TEST(MotionGear, AnAxisFollowsTheCommandedPositionOfAnother) {
  MotionBus bus;
  bus.enable();
  bus.each_cycle = [&] { bus.keep_alive(); };
  move_shoulder(bus, 1, 2.0, 1.0);
  bus.run(200);
  bus.send(bus.gear(2, "shoulder", -0.5));
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(1).gear == locked; }, 1000));
  EXPECT_EQ(bus.axis(1).id, 2);
  const double offset = bus.axis(1).position + 0.5 * bus.axis(0).position;

  for (int i = 0; i < 1500; ++i) {
    bus.run(1);
    ASSERT_NEAR(bus.axis(1).position, offset - 0.5 * bus.axis(0).position, 1e-5) << i;
  }
  EXPECT_EQ(bus.axis(0).state, standing);
  EXPECT_EQ(bus.axis(1).state, moving);
  EXPECT_EQ(bus.axis(1).gear, locked);
  EXPECT_NEAR(bus.position(1), offset - 1.0, 1e-3);
}

TEST(MotionGear, AnAxisFollowsAMeasuredPositionAtAPhase) {
  MotionBus bus;
  bus.enable();
  bus.each_cycle = [&] { bus.keep_alive(); };
  motion_gear_t gear = bus.gear(2, "shoulder", 1.0);
  gear.signal = "position_actual_value";
  gear.phase = "at";
  gear.goals[0].position = 0.25;
  bus.send(gear);
  bus.run(300);
  EXPECT_NEAR(bus.axis(1).position, 0.25, 2e-3);
  move_shoulder(bus, 3, 1.0, 0.4);
  bus.run(3000);

  EXPECT_EQ(bus.axis(1).gear, locked);
  EXPECT_NEAR(bus.axis(1).position, 1.25, 2e-3);
  EXPECT_NEAR(bus.axis(1).phase_error, 0.0, 2e-3);
}

TEST(MotionGear, AMoveTakesOverFromARunningGearWithoutAStop) {
  MotionBus bus;
  bus.enable();
  bus.each_cycle = [&] { bus.keep_alive(); };
  move_shoulder(bus, 1, 6.0, 1.0);
  bus.send(bus.gear(2, "shoulder", 1.0));
  bus.run(500);
  ASSERT_EQ(bus.axis(1).gear, locked);
  motion_command_t move = bus.command("move", 3);
  move.utime = 1;
  move.goals = {MotionBus::goal("elbow", 2.5)};
  bus.send(move);
  double slowest = 1.0;
  ASSERT_TRUE(bus.run_until(
      [&] {
        slowest = std::min(slowest, bus.axis(1).velocity);
        return bus.axis(1).id == 3;
      },
      100));

  EXPECT_GT(slowest, 0.99);
  EXPECT_EQ(bus.axis(1).gear, 0);
  bus.run(2000);
  EXPECT_NEAR(bus.axis(1).position, 2.5, 1e-9);
  EXPECT_EQ(bus.axis(1).outcome, test::done);
}

TEST(MotionGear, AnImpossibleMoveDoesNotEndAGear) {
  MotionBus bus;
  bus.enable();
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.send(bus.gear(2, "shoulder", 1.0));
  bus.run(100);
  motion_command_t move = bus.command("move", 3);
  move.utime = 1;
  move.goals = {MotionBus::goal("elbow", 1e9)};
  bus.send(move);
  bus.run(100);

  EXPECT_EQ(bus.axis(1).ended_id, 3);
  EXPECT_EQ(bus.axis(1).outcome, refused);
  EXPECT_EQ(bus.axis(1).id, 2);
}

TEST(MotionGear, TheSilenceOfItsSenderStopsAGear) {
  MotionBus bus;
  bus.enable();
  bus.send(bus.gear(2, "shoulder", 1.0));
  bus.run(20);
  ASSERT_EQ(bus.axis(1).state, moving);
  bus.run(400);

  EXPECT_EQ(bus.axis(1).ended_id, 2);
  EXPECT_EQ(bus.axis(1).outcome, stopped);
}

TEST(MotionGear, AStopEndsAGear) {
  MotionBus bus;
  bus.enable();
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.send(bus.gear(2, "shoulder", 1.0));
  bus.run(50);
  motion_command_t stop = bus.command("stop", 3);
  stop.goals = {MotionBus::goal("elbow", 0.0)};
  bus.send(stop);
  bus.run(50);

  EXPECT_EQ(bus.axis(1).state, standing);
  EXPECT_EQ(bus.axis(1).ended_id, 2);
}

TEST(MotionGear, ARingOfGearsIsRefused) {
  for (const char* signal : {"", "position_actual_value"}) {
    MotionBus bus;
    bus.enable();
    bus.each_cycle = [&] { bus.keep_alive(); };
    motion_gear_t gear = bus.gear(2, "shoulder", 1.0);
    gear.signal = signal;
    bus.send(gear);
    bus.run(20);
    ASSERT_EQ(bus.axis(1).state, moving);
    motion_gear_t back = bus.gear(3, "elbow", 1.0);
    back.signal = signal;
    back.goals = {MotionBus::goal("shoulder", 0.0)};
    bus.send(back);
    bus.run(20);
    EXPECT_TRUE(bus.said("motion_refused", "the leader follows this axis")) << signal;
    EXPECT_EQ(bus.axis(0).state, standing);
    EXPECT_EQ(bus.axis(1).state, moving) << "the gear that ran goes on";
  }
}

TEST(MotionGear, WhatIsWrongWithAGearIsSaid) {
  MotionBus bus;
  bus.enable();
  const auto refusal = [&](const auto& change, const std::string& why) {
    motion_gear_t gear = bus.gear(2, "shoulder", 1.0);
    change(gear);
    bus.send(gear);
    bus.run(5);
    EXPECT_TRUE(bus.said("motion_refused", why)) << why;
    EXPECT_NE(bus.axis(1).state, moving) << why;
  };
  refusal([](motion_gear_t& gear) { gear.leader = "none"; }, "'none' is no node of the bus");
  refusal([](motion_gear_t& gear) { gear.leader = "elbow"; }, "an axis can't follow itself");
  const auto follows = [](const char* node, const char* signal) {
    return [=](motion_gear_t& gear) {
      gear.leader = node;
      gear.signal = signal;
    };
  };
  refusal(follows("elbow", "position_actual_value"), "an axis can't follow itself");
  refusal([](motion_gear_t& gear) { gear.leader_axis = 3; }, "has no axis 3 that taktd can move");
  refusal([](motion_gear_t& gear) { gear.signal = "light"; }, "has no input 'light'");
  refusal([](motion_gear_t& gear) { gear.phase = "there"; }, "its phase is neither");
  refusal([](motion_gear_t& gear) { gear.modulo = -1.0; }, "its modulo is negative");
  refusal([](motion_gear_t& gear) { gear.filter_time = 11.0; }, "its filter time is not between");
  refusal([](motion_gear_t& gear) { gear.numerator = {std::nan("")}; }, "its ratio is infinite");
  refusal([](motion_gear_t& gear) { gear.max_phase_error = {-1.0}; },
          "its largest phase error is negative");
  refusal([](motion_gear_t& gear) { gear.goals[0].max_velocity = -1.0; }, "max_velocity is -1");
}

}  // namespace
}  // namespace takt
