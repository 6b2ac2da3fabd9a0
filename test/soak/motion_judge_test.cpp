// The judge of motions is fed with frames: good ones, and ones that break an invariant.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <vector>

#include "apps/takt/soak/judge/wire_judge.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/motion/beat/profile_player.hpp"
#include "master/motion/trajectory.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

constexpr SenderBit program = 1;
constexpr SenderBit other_program = 2;

/// Two axes, shoulder and elbow, with a cycle of 2 ms. The master sends a frame to each of them in
/// each cycle, and each of them answers.
class JudgedMotions : public testing::Test {
 protected:
  static constexpr double scale = 6.283185307179586e-4;
  /// In counts and seconds: the velocity is reached after 150 ms and 750 counts.
  static constexpr motion::Limits limits{.max_velocity = 10'000,
                                         .min_velocity = -10'000,
                                         .max_acceleration = 100'000,
                                         .min_acceleration = -100'000,
                                         .jerk = 2'000'000};

  JudgedMotions() { run(500ms); }

  /// Runs for this time; `programs` is the work of the programs in each cycle.
  void run(Time span, const std::function<void()>& programs = {}) {
    for (const Time end = now + span; now < end; now += 2ms) {
      judge.begin_cycle(now);
      judge.heard(make_frame(network.plan.cycle.sync_cob_id, {}));
      if (programs) programs();
      for (std::size_t axis = 0; axis < 2; ++axis) send(axis);
    }
  }
  void send(std::size_t axis) {
    for (const PdoRow& row : network.plan.pdos.tpdos) {
      if (row.node_index != axis || row.number != 1) continue;
      const std::uint8_t word = enabled[axis] ? 0x37 : 0x31;
      judge.heard(make_frame(row.cob_id, {word, 0x02, 0, 0, 0, 0x40}));
    }
    const auto counts = static_cast<std::uint32_t>(std::llround(path[axis](now)));
    for (const PdoRow& row : network.plan.pdos.rpdos) {
      if (row.node_index != axis || row.number != 1) continue;
      Frame frame = make_frame(row.cob_id, {0x06, 0x00, 0, 0, 0, 0});
      for (unsigned i = 0; i < 4; ++i) {
        frame.data[2 + i] = static_cast<std::uint8_t>(counts >> (8 * i));
      }
      judge.sent({&frame, 1}, now);
    }
  }
  motion_command_t message(const std::string& kind) const {
    motion_command_t command{};
    command.kind = kind;
    command.timeout_ms = timeout_ms;
    return command;
  }
  void alive(SenderBit sender = program) {
    judge.commanded({message("alive"), sender, now - 2ms}, now);
  }
  /// A program commands the axes to these positions, in counts.
  void command(const std::vector<std::pair<std::string, double>>& targets,
               SenderBit sender = program) {
    motion_command_t command = message("move");
    command.synchronisation = "none";
    for (const auto& [node, target] : targets) {
      motion_goal_t goal{};
      goal.node = node;
      goal.position = target * scale;
      goal.max_velocity = limits.max_velocity * scale;
      goal.max_acceleration = limits.max_acceleration * scale;
      goal.max_jerk = limits.jerk * scale;
      command.goals.push_back(goal);
    }
    judge.commanded({command, sender, now - 2ms}, now);
  }
  /// A program lets the shoulder follow an axis that stands.
  void follow() {
    motion_command_t gear = message("gear");
    motion_goal_t goal{};
    goal.node = "shoulder";
    goal.max_velocity = limits.max_velocity * scale;
    goal.max_acceleration = limits.max_acceleration * scale;
    goal.max_jerk = limits.jerk * scale;
    gear.goals.push_back(goal);
    judge.commanded({gear, program, now - 2ms}, now);
  }
  /// From `begin` on, the axis moves along these limits.
  void lead(std::size_t axis, double target, Time begin, const motion::Limits& along = limits) {
    const double from = path[axis](begin);
    const std::vector<motion::AxisTask> tasks{
        {.from = {.position = from}, .to = {.position = target}, .limits = along}};
    std::vector<motion::PlannedAxis> planned(1);
    ASSERT_TRUE(motion::plan_trajectory(tasks, {}, planned).has_value());
    path[axis] = [=, profile = planned[0].profile](Time when) {
      motion::ProfilePlayer player{profile, {.position = from}, motion::Ending::rest};
      return player.at(std::max(0.0, std::chrono::duration<double>(when - begin).count())).position;
    };
  }
  std::string broken() const { return verdict.good() ? "" : verdict.violation()->invariant; }

  LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");
  sim::World world{network.devices, {}};
  Verdict verdict;
  WireJudge judge{network.plan, world, verdict};
  Time now = 1s;
  std::int32_t timeout_ms = 200;
  std::array<bool, 2> enabled{true, true};
  std::array<std::function<double(Time)>, 2> path{[](Time) { return 0.0; },
                                                  [](Time) { return 0.0; }};
};

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

/// A gear stands while its leader stands, and moves when its leader does.
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

/// Both tests have a program that moves one axis, and axes that do as told, or nearly so.
class JudgedPaths : public JudgedMotions {
 protected:
  static constexpr double way = 4000;   // counts
  static constexpr double seconds = 1;  // of the path
  /// Part of the way on the path of smallest jerk.
  static double part(double time) {
    const double s = std::clamp(time / seconds, 0.0, 1.0);
    return s * s * s * (10 + s * (-15 + 6 * s));
  }
  double since(Time begin, Time when) const {
    return std::chrono::duration<double>(when - begin).count();
  }
  /// The path becomes late by a cycle while the axis moves.
  std::function<double(Time)> late(Time begin) const {
    return [this, begin](Time when) {
      const double time = since(begin, when);
      return way * part(time - 0.002 * std::clamp((time - 0.3) / 0.2, 0.0, 1.0));
    };
  }
  motion_goal_t goal() const {
    motion_goal_t goal{};
    goal.node = "shoulder";
    goal.max_velocity = limits.max_velocity * scale;
    goal.max_acceleration = limits.max_acceleration * scale;
    goal.max_jerk = limits.jerk * scale;
    return goal;
  }
  void command_stream() {
    motion_command_t command = message("stream");
    command.id = 5;
    command.goals.push_back(goal());
    command.goals[0].position = way * scale;
    motion_stream_t stream{};
    for (int i = 0; i <= 20; ++i) {
      const double s = i / 20.0;
      motion_point_t& point = stream.points.emplace_back();
      point.time = s * seconds;
      point.position = {part(point.time) * way * scale};
      point.velocity = {30 * s * s * (1 - s) * (1 - s) * way * scale / seconds};
      point.acceleration = {60 * s * (1 - s) * (1 - 2 * s) * way * scale / (seconds * seconds)};
    }
    judge.commanded({.command = command,
                     .sender = program,
                     .computed_from = now - 2ms,
                     .points_until = 1s,
                     .stream = &stream},
                    now);
  }
  /// The shoulder follows the elbow, which stands. Then the elbow moves, and the shoulder by
  /// `followed` of its way.
  void follow_elbow(double followed) {
    motion_command_t command = message("gear");
    command.goals.push_back(goal());
    motion_gear_t gear{};
    gear.leader = "elbow";
    gear.leader_axis = 1;
    gear.phase = "here";
    gear.goals = command.goals;
    gear.numerator = {1.0};
    gear.denominator = {1.0};
    judge.commanded(
        {.command = command, .sender = program, .computed_from = now - 2ms, .gear = &gear}, now);
    run(500ms, [&] { alive(); });
    motion::Limits slow = limits;
    slow.max_velocity /= 2;
    slow.min_velocity /= 2;
    slow.max_acceleration /= 2;
    slow.min_acceleration /= 2;
    slow.jerk /= 2;
    motion_command_t move = message("move");
    move.synchronisation = "none";
    move.goals.push_back(goal());
    move.goals[0].node = "elbow";
    move.goals[0].position = 20'000 * scale;
    move.goals[0].max_velocity /= 2;
    move.goals[0].max_acceleration /= 2;
    move.goals[0].max_jerk /= 2;
    judge.commanded({.command = move, .sender = program, .computed_from = now - 2ms}, now);
    lead(1, 20'000, now + 6ms, slow);
    path[0] = [=, leader = path[1]](Time when) { return leader(when) * followed; };
    run(5s, [&] { alive(); });
  }
};

TEST_F(JudgedPaths, AStreamThatKeepsToItsPathIsGood) {
  command_stream();
  path[0] = [this, begin = now + 8ms](Time when) { return way * part(since(begin, when)); };
  run(1500ms, [&] { alive(); });
  EXPECT_EQ(broken(), "") << verdict.violation()->what;
  EXPECT_EQ(judge.motions().paths().streams(), 1U);
}

TEST_F(JudgedPaths, AStreamThatIsLateByACycleIsFound) {
  command_stream();
  path[0] = late(now + 8ms);
  run(1500ms, [&] { alive(); });
  EXPECT_EQ(broken(), "a stream keeps to its path");
}

TEST_F(JudgedPaths, AStreamThatSomethingMayHaveDelayedIsNotJudged) {
  command_stream();
  path[0] = late(now + 8ms);
  run(300ms, [&] { alive(); });
  judge.disturbed(now + 1s);
  run(1200ms, [&] { alive(); });
  EXPECT_EQ(broken(), "") << verdict.violation()->what;
}

TEST_F(JudgedPaths, AGearThatKeepsItsRatioIsGood) {
  follow_elbow(1.0);
  EXPECT_EQ(broken(), "") << verdict.violation()->what;
  EXPECT_EQ(judge.motions().paths().gears(), 1U);
}

TEST_F(JudgedPaths, AGearWithAnotherRatioIsFound) {
  follow_elbow(1.0 + 2e-4);
  EXPECT_EQ(broken(), "a gear keeps its ratio");
}

}  // namespace
}  // namespace takt::soak
