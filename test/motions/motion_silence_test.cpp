// What motions do while their application or the front thread is silent.
#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>

#include "test/motions/motion_bus.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::MotionBus;

using test::moving;
using test::standing;
using test::stopped;
using test::stopping;

/// The main requirement for motions: the application runs at 50 Hz, its messages come up to 10 ms
/// late, and it stalls for 300 ms now and then. Nevertheless the drive gets the set-point of each
/// cycle: the second differences of the set-points stay as small as the limit of acceleration and
/// the rounding to counts allow.
TEST(MotionSilence, JitterAndStallsOfTheApplicationDoNotReachTheDrive) {
  MotionBus bus;
  bus.enable();
  std::mt19937_64 random{4};
  Time next = bus.world.now();
  std::int32_t id = 0;
  std::int64_t before = bus.target(0);
  std::int64_t step_before = 0;
  std::int64_t sharpest = 0;
  std::int64_t farthest = 0;
  std::uint64_t moved = 0;
  bus.each_cycle = [&] {
    const std::int64_t target = bus.target(0);
    const std::int64_t step = target - before;
    sharpest = std::max(sharpest, std::abs(step - step_before));
    farthest = std::max(farthest, std::abs(target));
    moved += step != 0;
    before = target;
    step_before = step;
    if (bus.world.now() < next) return;
    const Time jitter{static_cast<std::int64_t>(random() % 10'000'000)};
    next = bus.world.now() + (random() % 40 == 0 ? 300ms : 20ms) + jitter;
    if (++id % 25 == 1) {
      bus.move_one(id, std::uniform_real_distribution<double>{-2.0, 2.0}(random));
    } else {
      bus.keep_alive();
    }
  };
  bus.run(100'000);
  EXPECT_GT(moved, 50'000U);
  EXPECT_GT(farthest, 1500) << "counts";
  // 20 rad/s^2 are 0.13 counts in a beat squared; three roundings of half a count add two counts.
  EXPECT_LE(sharpest, 2) << "counts";
  EXPECT_TRUE(bus.enabled(0));
  EXPECT_FALSE(bus.said("motion_refused", "")) << bus.notices.back().text;
}

/// Returns the set-points of one motion. `speaks` decides in which cycles the application sends a
/// sign of life.
std::vector<std::int64_t> targets_of_motion(const std::function<bool(int cycle)>& speaks) {
  MotionBus bus;
  bus.enable();
  motion_command_t message = bus.command("move", 1);
  message.goals = {MotionBus::goal("shoulder", 12.0)};
  bus.send(message);
  std::vector<std::int64_t> targets;
  for (int cycle = 0; cycle < 2500; ++cycle) {
    bus.cycle();
    targets.push_back(bus.target(0));
    if (speaks(cycle)) bus.keep_alive();
  }
  return targets;
}

TEST(MotionSilence, AStallingApplicationGivesTheSameSetPointsAsAnIdealOne) {
  const auto ideal = targets_of_motion([](int) { return true; });
  const auto stalling = targets_of_motion(
      [](int cycle) { return cycle % 150 == 0 || (cycle % 10 == 0 && cycle < 1000); });
  EXPECT_EQ(ideal, stalling);
  EXPECT_NEAR(static_cast<double>(ideal.back()) * MotionBus::scale, 12.0, 1e-3);
  // Each cycle of the motion has a set-point of its own: 3 rad/s are 9.5 counts in a cycle.
  int alike = 0;
  for (std::size_t i = 200; i < 1800; ++i) alike += ideal[i] == ideal[i - 1];
  EXPECT_EQ(alike, 0);
}

TEST(MotionSilence, AnAxisStopsWhenItsApplicationHasDiedAndThenItsDriveIsDisabled) {
  MotionBus bus;
  bus.enable();
  motion_command_t message = bus.command("move", 3);
  message.goals = {MotionBus::goal("shoulder", 50.0)};
  message.timeout_ms = 300;
  bus.send(message);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == moving; }, 20));
  const Time began = bus.world.now();
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == stopping; }));
  EXPECT_NEAR(static_cast<double>((bus.world.now() - began).count()), 300e6, 15e6);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == standing; }));
  EXPECT_EQ(bus.axis(0).outcome, stopped);
  EXPECT_TRUE(bus.said("motion_stopped", "silent for longer than the timeout"));
  ASSERT_TRUE(bus.run_until([&] { return !bus.enabled(0); }, 1000));
}

TEST(MotionSilence, AFrozenFrontThreadStopsTheAxesAndItsOldMessagesMoveNothing) {
  MotionBus bus;
  bus.enable();
  bus.move_one(1, 50.0);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == moving; }, 20));
  bus.front_runs = false;  // SIGSTOP of the front thread; the application goes on for a while
  bus.each_cycle = [&, left = 200]() mutable {
    if (left-- > 0) bus.keep_alive();
  };
  bus.run(2000);
  const double rest = bus.position(0);
  bus.run(100);
  EXPECT_EQ(bus.position(0), rest);
  bus.move_one(2, 60.0);  // waits in the socket, and its sender dies
  bus.run(2000);
  bus.front_runs = true;
  bus.run(1000);
  EXPECT_NEAR(bus.position(0), rest, 1e-3);
}

/// SIGSTOP of the whole daemon: no cycles run, but the clock measures the silence of the sender.
TEST(MotionSilence, ADaemonThatWasStoppedForLongerThanTheTimeoutStopsTheAxisAtOnce) {
  MotionBus bus{{{.kind = sim::FaultKind::stall_master, .at = 3s, .until = 3600ms}}};
  bus.enable();
  bus.run_until([&] { return bus.world.now() > 2500ms; });
  bus.enable();
  bus.move_one(1, 50.0);
  bus.each_cycle = [&] {
    if (bus.world.now() < 2950ms) bus.keep_alive();
  };
  ASSERT_TRUE(bus.run_until([&] { return bus.world.now() > 2990ms; }));
  ASSERT_EQ(bus.axis(0).state, moving);
  const std::int64_t before = bus.target(0);
  ASSERT_TRUE(bus.run_until([&] { return bus.world.now() > 3500ms; }));
  bus.run(100);
  EXPECT_LE(bus.axis(0).state, standing);
  // One set-point may have been sent when the pause began.
  EXPECT_NEAR(static_cast<double>(bus.target(0)), static_cast<double>(before), 60.0);
  EXPECT_TRUE(bus.said("motion_stopped", "SYNC was missing"));
}

TEST(MotionSilence, AJogRunsUntilItsDeadManIsSilent) {
  MotionBus bus;
  bus.enable();
  motion_command_t jog = bus.command("jog", 4);
  jog.timeout_ms = 100;
  motion_goal_t goal = MotionBus::goal("elbow", 0.0);
  goal.velocity = -2.0;
  jog.goals = {goal};
  bus.send(jog);
  bus.each_cycle = [&] {
    motion_command_t alive = bus.command("alive", 0);
    alive.goals = {MotionBus::goal("elbow", 0.0)};
    bus.send(alive);
  };
  bus.run(1000);
  EXPECT_NEAR(bus.axis(1).velocity, -2.0, 1e-9);
  double sum = 0.0;  // one value is that of a whole number of counts
  for (int i = 0; i < 200; ++i) {
    bus.cycle();
    sum += bus.axis(1).actual_velocity;
  }
  EXPECT_NEAR(sum / 200, -2.0, 0.02);
  bus.each_cycle = {};
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(1).state == stopping; }, 60));
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(1).state == standing; }));
}

/// The program that holds the dead-man button is another part of the sender than the one that
/// reports that it is alive.
TEST(MotionSilence, ASignOfLifeThatDoesNotNameTheAxisDoesNotRenewAJog) {
  MotionBus bus;
  bus.enable();
  motion_command_t jog = bus.command("jog", 4);
  jog.timeout_ms = 100;
  jog.goals = {MotionBus::goal("elbow", 0.0)};
  jog.goals[0].velocity = -2.0;
  bus.send(jog);
  bus.move_one(5, 50.0);
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(1).state == moving; }, 20));
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(1).state == stopping; }, 60));
  EXPECT_TRUE(bus.said("motion_stopped", "silent for longer than the timeout"));
  bus.run(600);
  EXPECT_EQ(bus.axis(0).state, moving) << "a move is renewed";
  EXPECT_TRUE(bus.enabled(1)) << "the drive stays enabled while its sender is alive";
}

}  // namespace
}  // namespace takt
