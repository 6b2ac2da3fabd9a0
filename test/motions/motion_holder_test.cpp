// Who holds the node of an axis that motions move, and for how long.
#include <gtest/gtest.h>
#include <limits>

#include "test/motions/motion_bus.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::MotionBus;
using test::moving;
using test::stopping;

TEST(MotionHolder, AnotherProgramNeitherMovesNorStopsAHeldAxis) {
  MotionBus bus;
  bus.enable();
  bus.move_one(1, 3.0);
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == moving; }, 20));
  bus.move_one(2, -3.0, 99);
  motion_command_t stop = bus.command("stop", 0, 99);
  stop.goals = {MotionBus::goal("shoulder", 0.0)};
  bus.send(stop);
  bus.run(5);
  EXPECT_EQ(bus.axis(0).state, moving);
  EXPECT_EQ(bus.axis(0).id, 1);
  EXPECT_TRUE(bus.said("command_refused", "belong to"));
}

TEST(MotionHolder, AMotionStopsWhenItsSenderKeepsOnlyAnotherNode) {
  MotionBus bus;
  bus.enable();
  bus.move_one(1, 50.0);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == moving; }, 20));
  bus.each_cycle = [&] {
    motion_command_t alive = bus.command("alive", 0);
    alive.goals = {MotionBus::goal("elbow", 0.0)};
    bus.send(alive);
  };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == stopping; }, 510))
      << "the commands that have enabled the drive hold its node for 500 cycles";
}

/// The timeout is over before the motion can begin, but the sender is alive.
TEST(MotionHolder, AMotionWithAShortTimeoutBeginsAndIsNotRefusedMeanwhile) {
  MotionBus bus;
  bus.enable();
  motion_command_t message = bus.command("move", 1);
  message.goals = {MotionBus::goal("shoulder", 1.0)};
  message.timeout_ms = 5;
  bus.send(message);
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).id == 1; }, 20))
      << (bus.notices.empty() ? "nothing" : bus.notices.back().text);
  EXPECT_FALSE(bus.said("motion_refused", ""));
}

TEST(MotionHolder, ACommandOfOutputsDoesNotShortenTheHoldOfAMotion) {
  MotionBus bus;
  bus.enable();
  bus.move_one(1, 50.0);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == moving; }, 20));
  bus.send_controlword(0, 0x000F, 10);
  bus.run(200);
  EXPECT_EQ(bus.axis(0).state, moving);
  EXPECT_TRUE(bus.enabled(0));
}

TEST(MotionHolder, AStopOfOneAxisIsASignOfLifeForTheOthers) {
  MotionBus bus;
  bus.enable();
  bus.move_one(1, 50.0);
  bus.each_cycle = [&] {
    motion_command_t stop = bus.command("stop", 0);
    stop.goals = {MotionBus::goal("elbow", 0.0)};
    bus.send(stop);
  };
  bus.run(400);
  EXPECT_EQ(bus.axis(0).state, moving);
}

/// The elbow is without power for a moment, while its sender holds it.
TEST(MotionHolder, ASignOfLifeWithoutGoalsIsForTheNodesThatAreReady) {
  MotionBus bus{
      {{.kind = sim::FaultKind::power_off, .node = 2_node, .at = 3500ms, .until = 3520ms}},
      MotionBus::velocity_offset};
  bus.enable();
  bus.run_until([&] { return bus.world.now() > 2900ms; });
  bus.enable();
  bus.move_one(1, 50.0);
  motion_command_t move = bus.command("move", 2);
  move.goals = {MotionBus::goal("elbow", 1.0)};
  move.timeout_ms = 10'000;
  bus.send(move);
  bus.notices.clear();
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.run_until([&] { return bus.world.now() > 6000ms; });
  EXPECT_FALSE(bus.said("command_refused", ""));
  EXPECT_EQ(bus.axis(0).state, moving);
}

/// A release ends the claim of the sender: the axis stops along its limits, and then its drive is
/// disabled. 20 rad/s^2 are 0.13 counts in a beat squared, and rounding adds at most two counts.
TEST(MotionHolder, AReleaseStopsTheAxisBeforeItsDriveIsDisabled) {
  MotionBus bus;
  bus.enable();
  bus.move_one(1, 50.0);
  std::vector<std::int64_t> targets;
  bus.each_cycle = [&] { targets.push_back(bus.target(0)); };
  bus.run(200);
  ASSERT_EQ(bus.axis(0).state, moving);
  bus.release();
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == stopping; }, 5));
  EXPECT_TRUE(bus.enabled(0));
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state != stopping; }, 500));
  EXPECT_TRUE(bus.enabled(0));
  ASSERT_TRUE(bus.run_until([&] { return !bus.enabled(0); }, 10));
  EXPECT_TRUE(bus.said("motion_stopped", "does not hold the node any longer"));
  EXPECT_FALSE(bus.said("fallback_begun", ""));
  for (std::size_t i = 2; i < targets.size(); ++i) {
    EXPECT_LE(std::abs(targets[i] - 2 * targets[i - 1] + targets[i - 2]), 2) << i;
  }
}

/// With a sign of life from a later image, the sender takes the node again, but the motion does not
/// continue.
TEST(MotionHolder, AReleaseStopsTheAxisAlsoIfASignOfLifeFollowsInTheSameRound) {
  for (const bool overtakes : {false, true}) {
    MotionBus bus;
    bus.enable();
    bus.move_one(1, 50.0);
    bus.each_cycle = [&] { bus.keep_alive(); };
    bus.run(200);
    ASSERT_EQ(bus.axis(0).state, moving);
    motion_command_t alive = bus.command("alive", 0);
    ++alive.cycle;
    alive.goals = {MotionBus::goal("shoulder", 0.0)};
    if (overtakes) bus.send(alive);
    bus.release();
    if (!overtakes) bus.send(alive);
    ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == stopping; }, 5)) << overtakes;
    EXPECT_TRUE(bus.said("motion_stopped", "does not hold the node any longer"));
  }
}

/// The motion is on its way to the bus thread, or waits to be planned.
TEST(MotionHolder, AReleaseEndsAMotionThatHasNotBegunAlthoughASignOfLifeFollows) {
  MotionBus bus;
  bus.enable();
  bus.move_one(1, 50.0);
  motion_command_t alive = bus.command("alive", 0);
  ++alive.cycle;
  alive.goals = {MotionBus::goal("shoulder", 0.0)};
  bus.release();
  bus.send(alive);
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.run(50);
  EXPECT_NE(bus.axis(0).state, moving);
  EXPECT_TRUE(bus.said("motion_refused", "does not hold the nodes any longer"));
}

TEST(MotionHolder, AMotionThatIsRefusedTakesNoNode) {
  MotionBus bus;
  ASSERT_TRUE(bus.run_until([&] { return bus.bridge.status().bus.cycle > 500; }));
  bus.keep_alive();
  bus.run(3);
  bus.move_one(1, std::numeric_limits<double>::quiet_NaN(), 9);
  bus.move_one(2, 1.0, 9);  // is planned, but the drive is not enabled
  bus.run(3);
  EXPECT_TRUE(bus.said("motion_refused", "infinite, NaN or too large"));
  EXPECT_TRUE(bus.said("motion_refused", "does not follow set-points"));
  motion_command_t alive = bus.command("alive", 0, 5);
  alive.goals = {MotionBus::goal("shoulder", 0.0)};
  bus.send(alive);
  bus.run(3);
  EXPECT_FALSE(bus.said("command_refused", "belong to"));
}

TEST(MotionHolder, AnOldMessageHoldsItsNodeOnlyForTheRestOfItsTimeout) {
  MotionBus bus;
  ASSERT_TRUE(bus.run_until([&] { return bus.bridge.status().bus.cycle > 500; }));
  const auto alive = [&](std::int64_t instance, std::int32_t timeout_ms) {
    motion_command_t message = bus.command("alive", 0, instance);
    message.goals = {MotionBus::goal("shoulder", 0.0)};
    message.timeout_ms = timeout_ms;
    return message;
  };
  const motion_command_t old = alive(9, 300);
  bus.run(100);  // 200 ms
  bus.send(old);
  bus.run(45);
  bus.send(alive(5, 300));
  bus.run(2);
  EXPECT_TRUE(bus.said("command_refused", "belong to"));
  bus.notices.clear();
  bus.run(10);
  bus.send(alive(5, 300));
  bus.run(2);
  EXPECT_FALSE(bus.said("command_refused", ""));
  const motion_command_t older = alive(5, 100);
  bus.run(60);
  bus.send(older);
  bus.run(2);
  EXPECT_TRUE(bus.said("motion_refused", "older than its timeout"));
}

}  // namespace
}  // namespace takt
