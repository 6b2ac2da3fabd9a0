// Motions over LCM, from the bytes of motion_command_t to the simulated drives.
#include <algorithm>
#include <gtest/gtest.h>

#include "test/motions/motion_bus.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;
using test::MotionBus;

using test::done;
using test::moving;
using test::refused;
using test::standing;
using test::stopped;
using test::stopping;

/// Before the first sign of life, motions cost the bus thread nothing. After it, a target position
/// that nobody has commanded follows the actual position.
TEST(MotionCommand, TheBusThreadReadsTheAxesFromTheFirstSignOfLifeOn) {
  MotionBus bus;
  bus.run(10);
  MotionSnapshot now;
  bus.master.motions(now);
  EXPECT_EQ(now.cycle, 0U);
  bus.keep_alive();
  bus.run(10);
  bus.master.motions(now);
  EXPECT_NE(now.cycle, 0U);
  EXPECT_TRUE(bus.lcm.motion.axes.empty());
}

TEST(MotionCommand, MovesTwoAxesThatArriveTogether) {
  MotionBus bus;
  bus.enable();
  bus.move_both(11, 1.0, -0.4);
  ASSERT_TRUE(
      bus.run_until([&] { return !bus.lcm.motion.axes.empty() && bus.axis(0).id == 11; }, 20));
  EXPECT_EQ(bus.axis(1).id, 11);
  EXPECT_NEAR(bus.axis(0).time_left, bus.axis(1).time_left, 0.003);
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(
      bus.run_until([&] { return bus.axis(0).ended_id == 11 && bus.axis(1).ended_id == 11; }));
  EXPECT_EQ(bus.axis(0).outcome, done);
  bus.run(20);
  EXPECT_NEAR(bus.position(0), 1.0, 1e-3);
  EXPECT_NEAR(bus.position(1), -0.4, 1e-3);
}

TEST(MotionCommand, AHaltOfTheDriveStopsTheMotion) {
  MotionBus bus;
  bus.enable();
  bus.move_one(1, 50.0);
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == moving; }, 20));
  bus.run(200);
  bus.send_controlword(0, 0x010F);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == stopping; }, 10));
  EXPECT_EQ(bus.axis(0).outcome, stopped);
  EXPECT_TRUE(bus.said("motion_stopped", "the Halt bit"));
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == standing; }));
  bus.move_one(2, 50.0);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).ended_id == 2; }, 20));
  EXPECT_EQ(bus.axis(0).outcome, refused);
  EXPECT_TRUE(bus.said("motion_refused", "without a Halt"));
  bus.send_controlword(0, 0x000F);
  bus.run(5);
  bus.move_one(3, 50.0);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == moving; }, 20));
}

TEST(MotionCommand, ReportsThatAnNmtCommandHasEndedAMotion) {
  MotionBus bus;
  bus.enable();
  bus.move_one(1, 50.0);
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.run(200);
  ASSERT_EQ(bus.axis(0).state, moving);
  ASSERT_TRUE(bus.master.submit(
      {.id = 1, .kind = RequestKind::nmt, .node = 0, .command = NmtCommand::stop}));
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state != moving; }, 50));
  EXPECT_TRUE(bus.said("motion_stopped", "an NMT command stops the drive"))
      << (bus.notices.empty() ? "nothing" : bus.notices.back().text);
}

/// Relative to the commanded position in the cycle in which the motion begins, also while the axis
/// moves.
TEST(MotionCommand, MovesByADistance) {
  MotionBus bus;
  bus.enable();
  const auto move_by = [&](std::int32_t id, double shoulder, double elbow) {
    motion_command_t message = bus.command("move_by", id);
    message.goals = {MotionBus::goal("shoulder", shoulder), MotionBus::goal("elbow", elbow)};
    bus.send(message);
    return message;
  };
  bus.each_cycle = [&] { bus.keep_alive(); };
  move_by(1, 0.5, -0.25);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).ended_id == 1; }));
  const motion_command_t second = move_by(2, 0.5, 0.5);
  bus.send(second);  // a copy
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).ended_id == 2 && bus.axis(0).id == 0; }));
  EXPECT_TRUE(bus.said("motion_refused", "a copy, which must not move the axis again"));
  EXPECT_NEAR(bus.axis(0).position, 1.0, 1e-9);
  EXPECT_NEAR(bus.axis(1).position, 0.25, 1e-9);
  bus.move_one(3, 5.0);
  bus.run(300);
  ASSERT_EQ(bus.axis(0).state, moving);
  motion_command_t back = bus.command("move_by", 4);
  back.goals = {MotionBus::goal("shoulder", -0.5)};
  bus.send(back);
  double begin = 0.0;
  ASSERT_TRUE(bus.run_until([&] {
    begin = bus.axis(0).position;
    return bus.axis(0).id == 4;
  }));
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).ended_id == 4; }));
  EXPECT_NEAR(bus.axis(0).position, begin - 0.5, 1e-9);
  bus.notices.clear();
  motion_command_t far = bus.command("move_by", 5);
  far.goals = {MotionBus::goal("shoulder", 99.0)};
  bus.send(far);
  bus.run(5);
  EXPECT_TRUE(bus.said("motion_refused", "would leave its range of positions"));
}

TEST(MotionCommand, StopEndsTheMotionOfTheWholeGroup) {
  MotionBus bus;
  bus.enable();
  bus.move_both(1, 40.0, 40.0);
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.run(300);
  motion_command_t stop = bus.command("stop", 0);
  stop.goals = {MotionBus::goal("elbow", 0.0)};
  bus.send(stop);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == stopping; }, 5));
  EXPECT_EQ(bus.axis(1).state, stopping);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == standing; }));
  EXPECT_TRUE(bus.said("motion_stopped", "its sender has stopped it"));
  EXPECT_TRUE(std::ranges::all_of(bus.notices, [](const Notice& notice) {
    return notice.kind != "motion_stopped" || notice.weight == Weight::note;
  })) << "a stop that the application requests is no warning";
  bus.move_one(2, 10.0);
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(0).state == moving; }, 20));
  EXPECT_TRUE(bus.enabled(0));
}

TEST(MotionCommand, RefusesWithTheReason) {
  MotionBus bus;
  bus.enable();
  bus.move_one(1, 0.0);  // holds the node
  bus.each_cycle = [&] { bus.keep_alive(); };
  bus.run(700);
  const auto refusal = [&](auto change, const std::string& words) {
    bus.notices.clear();
    motion_command_t message = bus.command("move", 77);
    message.goals = {MotionBus::goal("shoulder", 1.0)};
    change(message);
    bus.send(message);
    bus.run(10);
    EXPECT_TRUE(bus.said("motion_refused", words) || bus.said("command_refused", words))
        << words << ": " << (bus.notices.empty() ? "nothing" : bus.notices.back().text);
    EXPECT_EQ(bus.axis(0).state, standing) << words;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using Command = motion_command_t;
  refusal([](Command& m) { m.goals[0].node = "knee"; }, "'knee' has no axis 1");
  refusal([](Command& m) { m.goals[0].axis = 3; }, "has no axis 3");
  refusal([](Command& m) { m.goals.clear(); }, "it names no axis");
  refusal([](Command& m) { m.kind = "fly"; }, "its kind is not one of");
  refusal([](Command& m) { m.synchronisation = "some"; }, "its synchronisation is not one of");
  refusal([](Command& m) { m.timeout_ms = 10'001; }, "its timeout of 10001 ms");
  refusal([](Command& m) { m.goals[0].max_velocity = 41.0; },
          "`limits:` of the network file or the drive allow 40");
  refusal([](Command& m) { m.goals[0].max_acceleration = -1.0; }, "must be above 0");
  refusal([&](Command& m) { m.goals[0].max_jerk = nan; }, "must be above 0");
  refusal([&](Command& m) { m.goals[0].position = nan; }, "infinite, NaN or too large");
  refusal([](Command& m) { m.goals[0].position = 1e13; }, "too large");
  refusal([](Command& m) { m.goals[0].max_acceleration = 1e-10; }, "is not between");
  refusal([](Command& m) { m.goals[0].max_jerk = 1e187; }, "is not between");
  refusal([&](Command& m) { m.goals[0].max_following_error = nan; },
          "max_following_error is nan: it must be above 0");
  refusal([](Command& m) { m.goals[0].position = 100.5; }, "would leave its range of positions");
  refusal([](Command& m) { m.goals.push_back(m.goals[0]); }, "named twice");
  refusal([](Command& m) { m.session = 8; }, "another session");
  refusal([](Command& m) { m.schema = 1; }, "schema");
  refusal([](Command& m) { m.instance = 0; }, "instance 0");
  refusal([](Command& m) { m.cycle = 0; }, "does not exist");
  refusal([](Command& m) { m.cycle -= 600; }, "too old");
  EXPECT_EQ(bus.axis(0).ended_id, 77);
  EXPECT_EQ(bus.axis(0).outcome, refused);
  EXPECT_NEAR(bus.position(0), 0.0, 1e-6);
}

/// 0.1 rad for the elbow; 0.1 mrad for the shoulder, which any motion exceeds.
TEST(MotionCommand, TheNetworkFileLimitsTheFollowingError) {
  MotionBus bus{{}, TAKT_SOURCE_DIR "/test/motions/data/following_error.yaml"};
  bus.enable();
  motion_command_t message = bus.command("move", 5);
  message.goals = {MotionBus::goal("elbow", 1.0)};
  message.goals[0].max_following_error = 0.2;
  bus.send(message);
  bus.run(3);
  EXPECT_TRUE(bus.said("motion_refused", "`limits:` of the network file or the drive allow 0.1"));
  bus.move_both(6, 10.0, 10.0);
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(1).state == stopping; }, 200));
  EXPECT_TRUE(bus.said("motion_stopped", "because of shoulder: the following error is above"));
}

TEST(MotionCommand, AFollowingErrorAboveItsLimitStopsTheGroup) {
  MotionBus bus;
  bus.enable();
  motion_command_t message = bus.command("move", 5);
  message.goals = {MotionBus::goal("shoulder", 40.0), MotionBus::goal("elbow", 40.0)};
  message.goals[0].max_following_error = 1e-5;  // less than a count
  bus.send(message);
  bus.each_cycle = [&] { bus.keep_alive(); };
  ASSERT_TRUE(bus.run_until([&] { return bus.axis(1).state == stopping; }, 1000));
  EXPECT_TRUE(bus.said("motion_stopped", "the following error is above its limit"));
  EXPECT_TRUE(bus.said("motion_stopped", "because of shoulder"));
}

}  // namespace
}  // namespace takt
