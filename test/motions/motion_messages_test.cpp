// Messages of motions that come twice, late, in another order, or for a node that is not ready.
#include <gtest/gtest.h>

#include "test/motions/motion_bus.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::MotionBus;

constexpr std::int8_t axis_moves = 2;
constexpr std::int8_t axis_brakes = 3;

motion_command_t move_of(MotionBus& bus, std::int32_t id, double shoulder, std::int64_t utime) {
  motion_command_t message = bus.command("move", id);
  message.utime = utime;
  message.goals = {MotionBus::goal("shoulder", shoulder)};
  return message;
}

motion_command_t stop_of(MotionBus& bus, std::initializer_list<const char*> nodes) {
  motion_command_t message = bus.command("stop", 0);
  for (const char* node : nodes) message.goals.push_back(MotionBus::goal(node, 0.0));
  return message;
}

TEST(MotionMessages, ACopyOfAMoveDoesNotStartTheAxisAgainAfterItsStop) {
  MotionBus bus;
  bus.enable();
  const motion_command_t move = move_of(bus, 1, 20.0, 1000);
  const motion_command_t stop = stop_of(bus, {"shoulder"});
  bus.send(move);
  bus.send(stop);
  bus.send(move);
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.run(50);
  EXPECT_NE(bus.axis(0).state, axis_moves);
  EXPECT_TRUE(bus.said("motion_refused", "not newer than the stop"));
  bus.send(move_of(bus, 2, 20.0, 3000));
  EXPECT_TRUE(bus.run_until([&] { return bus.axis(0).state == axis_moves; }, 20));
}

TEST(MotionMessages, ACopyOfTheOlderOfTwoMovesOfOneImageDoesNotLeadTheAxisBack) {
  MotionBus bus;
  bus.enable();
  const motion_command_t older = move_of(bus, 1, 20.0, 1000);
  bus.send(older);
  bus.send(move_of(bus, 2, -20.0, 2000));
  bus.send(older);
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == axis_moves; }, 20));
  EXPECT_EQ(bus.axis(0).id, 2);
}

/// A program may leave utime at 0. Then the gateway can't distinguish a copy from a motion that
/// arrives out of order, and refuses the motion.
TEST(MotionMessages, ACopyOfAMoveByIsKnownAlsoBehindAnotherMotionOfItsImage) {
  MotionBus bus;
  bus.enable();
  motion_command_t first = bus.command("move_by", 1);
  first.goals = {MotionBus::goal("shoulder", 0.5)};
  bus.send(first);
  bus.send(move_of(bus, 2, 1.0, 0));
  bus.send(first);
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).ended_id == 2; }, 2000));
  EXPECT_TRUE(bus.said("motion_refused", "may be a copy"));
  EXPECT_NEAR(bus.axis(0).position, 1.0, 1e-9);
}

/// The orders of the first motion are on their way when the second one is refused and the sender
/// gives up its nodes.
TEST(MotionMessages, AMotionOnItsWayIsStoppedByAReleaseAlsoIfAnotherOneWasRefused) {
  MotionBus bus;
  bus.enable();
  bus.send(move_of(bus, 1, 20.0, 1000));
  bus.send(move_of(bus, 2, 1e6, 2000));
  bus.release();
  bus.run(3);
  EXPECT_TRUE(bus.said("motion_refused", "would leave its range of positions"));
  EXPECT_TRUE(bus.said("motion_refused", "does not hold the nodes any longer"));
  bus.each_cycle = [&] { EXPECT_NE(bus.axis(0).state, axis_moves); };
  bus.run(20);
}

/// The elbow has no power. Both axes are free.
TEST(MotionMessages, ARefusedCommandTakesNoNode) {
  MotionBus bus{{{.kind = sim::FaultKind::power_off, .node = 2_node, .at = 3500ms, .until = 20s}},
                MotionBus::velocity_offset};
  bus.enable();
  bus.run_until([&] { return bus.world.now() > 6s; });
  motion_command_t both = bus.command("move", 1, 98);
  both.goals = {MotionBus::goal("shoulder", 1.0), MotionBus::goal("elbow", 1.0)};
  bus.send(both);
  bus.run(2);
  ASSERT_TRUE(bus.said("command_refused", "elbow"));
  bus.move_one(2, 1.0, 99);
  bus.run(2);
  EXPECT_FALSE(bus.said("command_refused", "belong to"));
}

/// The elbow has no power; both axes are named, and so is one that does not exist.
TEST(MotionMessages, AStopIsNotLostIfAnotherNodeIsNotReady) {
  MotionBus bus{{{.kind = sim::FaultKind::power_off, .node = 2_node, .at = 3500ms, .until = 20s}},
                MotionBus::velocity_offset};
  bus.enable();
  bus.run_until([&] { return bus.world.now() > 2900ms; });
  bus.enable();
  bus.move_one(1, 50.0);
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.run_until([&] { return bus.world.now() > 4600ms; });
  ASSERT_EQ(bus.axis(0).state, axis_moves);
  bus.each_cycle = {};
  motion_command_t stop = stop_of(bus, {"elbow", "knee", "shoulder"});
  stop.timeout_ms = 99'999;
  bus.send(stop);
  EXPECT_TRUE(bus.run_until([&] { return bus.axis(0).state == axis_brakes; }, 10));
}

TEST(MotionMessages, ACopyOfAStopDoesNotStopTheNextMotion) {
  MotionBus bus;
  bus.enable();
  bus.each_cycle = [&] { bus.keep_alive(); };
  motion_command_t stop = stop_of(bus, {"shoulder"});
  stop.utime = 1000;
  bus.send(stop);
  bus.run(3);
  bus.send(move_of(bus, 1, 20.0, 2000));
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == axis_moves; }, 20));
  bus.send(stop);
  bus.run(10);
  EXPECT_EQ(bus.axis(0).state, axis_moves);
  stop.utime = 3000;
  bus.send(stop);
  EXPECT_TRUE(bus.run_until([&] { return bus.axis(0).state == axis_brakes; }, 10));
}

TEST(MotionMessages, AStopThatALaterMessageHasOvertakenIsNotLost) {
  MotionBus bus;
  bus.enable();
  bus.move_one(1, 50.0);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == axis_moves; }, 20));
  const motion_command_t stop = stop_of(bus, {"shoulder"});
  bus.run(3);
  bus.keep_alive();
  bus.run(1);
  bus.send(stop);
  EXPECT_TRUE(bus.run_until([&] { return bus.axis(0).state == axis_brakes; }, 10));
}

TEST(MotionMessages, AnOrderOnItsWayDoesNotBeginAfterTheRelease) {
  MotionBus bus;
  bus.enable();
  bus.move_one(1, 0.5);
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).ended_id == 1; }));
  bus.run(2);
  bus.each_cycle = {};
  bus.move_one(2, 50.0);
  bus.run(1);
  bus.release();
  bool moved = false;
  bus.each_cycle = [&] { moved |= bus.axis(0).state == axis_moves; };
  bus.run(20);
  EXPECT_FALSE(moved);
}

}  // namespace
}  // namespace takt
