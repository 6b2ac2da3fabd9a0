// The judge of motions is fed with frames: good ones, and ones that break an invariant.
#include "test/soak/judged_motions.hpp"

namespace takt::soak {
namespace {

TEST_F(JudgedMotions, AreGoodWhileTheirProgramIsAliveAndEndAtTheirTargets) {
  command({{"shoulder", 5000}, {"elbow", -4000}});
  lead(0, 5000, now + 6ms);
  lead(1, -4000, now + 6ms);

  run(2s, [&] { alive(); });

  EXPECT_EQ(broken(), "") << verdict.violation()->what;
  EXPECT_EQ(judge.motions().arrivals(), 2U);
  EXPECT_EQ(judge.motions().groups(), 1U);
}

/// 10,000 counts/s need 150 ms to stop.
TEST_F(JudgedMotions, EndWithTheirStopIfTheirProgramIsSilent) {
  command({{"shoulder", 20'000}});
  lead(0, 20'000, now + 6ms);

  run(350ms);
  EXPECT_EQ(broken(), "");
  run(350ms);

  EXPECT_EQ(broken(), "an axis moves only while its sender commands it");
}

TEST_F(JudgedMotions, AreBlamedIfNobodyHasCommandedThem) {
  command({{"shoulder", 50}});
  lead(0, 50, now + 6ms);
  run(2s, [&] { alive(); });
  ASSERT_EQ(broken(), "");

  lead(0, 2000, now + 6ms);
  run(100ms, [&] { alive(); });

  EXPECT_EQ(broken(), "an axis moves only while its sender commands it");
}

TEST_F(JudgedMotions, KeepTheirVelocity) {
  motion::Limits fast = limits;
  fast.max_velocity = 11'000;
  command({{"shoulder", 20'000}});
  lead(0, 20'000, now + 6ms, fast);

  run(500ms, [&] { alive(); });

  EXPECT_EQ(broken(), "a motion keeps its limits");
}

TEST_F(JudgedMotions, KeepTheirAcceleration) {
  motion::Limits hard = limits;
  hard.max_acceleration = 700'000;
  hard.jerk = 2e7;
  command({{"shoulder", 20'000}});
  lead(0, 20'000, now + 6ms, hard);

  run(500ms, [&] { alive(); });

  EXPECT_EQ(broken(), "a motion keeps its limits");
}

TEST_F(JudgedMotions, BeginWithoutAJump) {
  command({{"shoulder", 20'000}});
  path[0] = [begin = now + 6ms](Time when) { return when < begin ? 0.0 : 8.0; };

  run(100ms, [&] { alive(); });

  EXPECT_EQ(broken(), "a motion keeps its limits");
}

TEST_F(JudgedMotions, EndAlongTheirLimits) {
  command({{"shoulder", 20'000}});
  lead(0, 20'000, now + 6ms);
  run(500ms, [&] { alive(); });
  ASSERT_EQ(broken(), "");
  path[0] = [at = path[0](now)](Time) { return at; };

  run(100ms, [&] { alive(); });

  EXPECT_EQ(broken(), "a motion keeps its limits");
}

/// The drive gets one set-point twice, and then one that is two periods away.
TEST_F(JudgedMotions, MoveByTheWayOfOnePeriodFromSyncToSync) {
  command({{"shoulder", 20'000}});
  lead(0, 20'000, now + 6ms);
  run(500ms, [&] { alive(); });
  ASSERT_EQ(broken(), "");
  now += 2ms;
  judge.begin_cycle(now);
  now += 2ms;

  run(2ms, [&] { alive(); });

  EXPECT_EQ(broken(), "a motion keeps its limits");
}

/// A program that is alive does not hold the button of a jog.
TEST_F(JudgedMotions, OfAJogEndIfItsAxisIsNotNamed) {
  motion_command_t jog = message("jog");
  motion_goal_t goal{};
  goal.node = "shoulder";
  goal.velocity = goal.max_velocity = limits.max_velocity * scale;
  goal.max_acceleration = limits.max_acceleration * scale;
  goal.max_jerk = limits.jerk * scale;
  jog.goals.push_back(goal);
  judge.commanded({jog, program, now - 2ms}, now);
  lead(0, 50'000, now + 6ms);
  run(300ms, [&] {
    motion_command_t named = message("alive");
    named.goals.push_back(goal);
    judge.commanded({named, program, now - 2ms}, now);
  });

  run(350ms, [&] { alive(); });
  EXPECT_EQ(broken(), "");
  run(350ms, [&] { alive(); });

  EXPECT_EQ(broken(), "an axis moves only while its sender commands it");
}

/// The axis of a gear is at standstill while its leader is, and moves when the leader moves.
TEST_F(JudgedMotions, OfAGearLastAsLongAsTheirProgramIsAlive) {
  follow();
  run(10s, [&] { alive(); });
  lead(0, 20'000, now + 6ms);

  run(3s, [&] { alive(); });

  EXPECT_EQ(broken(), "") << verdict.violation()->what;
  EXPECT_EQ(judge.motions().orders().gears(), 1U);
}

TEST_F(JudgedMotions, OfAGearEndIfTheirProgramIsSilent) {
  follow();
  run(100ms, [&] { alive(); });
  lead(0, 20'000, now + 6ms);

  run(350ms);
  EXPECT_EQ(broken(), "");
  run(350ms);

  EXPECT_EQ(broken(), "an axis moves only while its sender commands it");
}

TEST_F(JudgedMotions, OfAGearKeepTheirLimitsWhateverTheirLeaderDoes) {
  follow();
  run(100ms, [&] { alive(); });
  motion::Limits fast = limits;
  fast.max_velocity = 11'000;
  lead(0, 20'000, now + 6ms, fast);

  run(500ms, [&] { alive(); });

  EXPECT_EQ(broken(), "a motion keeps its limits");
}

/// The points of a stream are sent 400 ms in advance. Without further ones, it stops.
TEST_F(JudgedMotions, OfAStreamEndWithItsPoints) {
  motion_command_t stream = message("stream");
  stream.id = 5;
  motion_goal_t goal{};
  goal.node = "shoulder";
  goal.position = 20'000 * scale;
  goal.max_velocity = limits.max_velocity * scale;
  goal.max_acceleration = limits.max_acceleration * scale;
  goal.max_jerk = limits.jerk * scale;
  stream.goals.push_back(goal);
  const Time begin = now;
  judge.commanded({stream, program, now - 2ms, 400ms}, now);
  lead(0, 20'000, now + 6ms);
  stream.kind = "points";
  run(600ms, [&] { judge.commanded({stream, program, now - 2ms, now - begin + 400ms}, now); });
  EXPECT_EQ(judge.motions().orders().streams(), 1U);
  EXPECT_EQ(broken(), "");

  path[0] = [from = path[0](now - 2ms), since = now - 2ms](Time when) {
    return from + 1e4 * std::chrono::duration<double>(when - since).count();
  };
  run(1300ms, [&] { alive(); });
  EXPECT_EQ(broken(), "");
  run(500ms, [&] { alive(); });

  EXPECT_EQ(broken(), "an axis moves only while its sender commands it");
}

/// The second axis begins one cycle later.
TEST_F(JudgedMotions, BeginInOneCycleAsAGroup) {
  command({{"shoulder", 5000}, {"elbow", -4000}});
  lead(0, 5000, now + 6ms);
  lead(1, -4000, now + 8ms);

  run(2s, [&] { alive(); });

  EXPECT_EQ(broken(), "a group begins in one cycle");
}

TEST_F(JudgedMotions, BeginAllOfThemAsAGroup) {
  command({{"shoulder", 5000}, {"elbow", -4000}});
  lead(0, 5000, now + 6ms);

  run(2s, [&] { alive(); });

  EXPECT_EQ(broken(), "a group begins in one cycle");
}

TEST_F(JudgedMotions, EndAllOfThemIfOneDriveOfTheGroupFails) {
  command({{"shoulder", 50'000}, {"elbow", 40'000}});
  lead(0, 50'000, now + 6ms);
  lead(1, 40'000, now + 6ms);
  run(600ms, [&] { alive(); });
  enabled[1] = false;

  run(150ms, [&] { alive(); });
  EXPECT_EQ(broken(), "");
  run(300ms, [&] { alive(); });

  EXPECT_EQ(broken(), "an axis moves only while its sender commands it");
}

TEST_F(JudgedMotions, DoNotTakeWhatAnotherProgramHolds) {
  timeout_ms = 500;
  command({{"shoulder", 400}});
  lead(0, 400, now + 6ms);
  run(160ms, [&] { alive(); });
  command({{"shoulder", 400}});
  run(190ms, [&] { alive(); });
  ASSERT_EQ(broken(), "");

  command({{"shoulder", 416}}, other_program);
  lead(0, 416, now);
  run(300ms, [&] { alive(other_program); });

  EXPECT_EQ(broken(), "no sender moves what another holds");
}

}  // namespace
}  // namespace takt::soak
