// The judge of paths is fed with streams and gears: good ones, and ones that leave their paths.
#include <algorithm>
#include <chrono>
#include <functional>

#include "test/soak/judged_motions.hpp"

namespace takt::soak {
namespace {

/// A program moves the shoulder by a stream or by a gear. The shoulder follows exactly, or nearly.
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
  /// The shoulder follows the elbow, which is at standstill. Then the elbow moves, and the shoulder
  /// by `followed` of its way.
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
