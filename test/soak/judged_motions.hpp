#pragma once
// The judge of motions is fed with frames of two axes.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

#include "apps/takt/soak/judge/wire_judge.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/motion/beat/profile_player.hpp"
#include "master/motion/trajectory.hpp"

namespace takt::soak {

using namespace std::chrono_literals;

inline constexpr SenderBit program = 1;
inline constexpr SenderBit other_program = 2;

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
  /// A program lets the shoulder follow an axis at standstill.
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
  /// From `begin` on, the axis moves to `target` within these limits.
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

}  // namespace takt::soak
