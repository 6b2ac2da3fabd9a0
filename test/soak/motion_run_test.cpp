// Runs of the front thread in which programs command motions: a judge has to find the invariant
// that a test breaks.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <string>

#include "apps/takt/soak/front_run.hpp"

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

class MotionDefects : public testing::Test {
 protected:
  /// Returns true if one of the seeds breaks this invariant; "" means any invariant.
  bool breaks(const FrontDefect& defect, const std::string& invariant) {
    for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
      const SoakOutcome outcome = soak_front(
          network, {.seed = seed, .duration = 20s, .motions = MotionRuns::all, .front = defect});
      motions += outcome.motions;
      arrivals += outcome.arrivals;
      groups += outcome.groups;
      gears += outcome.gears;
      streams += outcome.streams;
      judged_streams += outcome.judged_streams;
      judged_gears += outcome.judged_gears;
      if (!outcome.violation) continue;
      what += fmt::format("seed {}: {}: {}\n", seed, outcome.violation->invariant,
                          outcome.violation->what);
      if (!invariant.empty() && outcome.violation->invariant != invariant) continue;
      RecordProperty("seed", static_cast<int>(seed));
      return true;
    }
    return false;
  }
  /// Changes each message about motions before the daemon receives it.
  template <class Change>
  static FrontDefect changed(Change change) {
    return {.motion = [change](motion_command_t command, const SeenCycles& cycles) {
      change(command, cycles);
      return std::vector{command};
    }};
  }

  LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");
  std::uint64_t first = 1;
  std::uint64_t seeds = 40;
  std::uint64_t motions = 0;
  std::uint64_t arrivals = 0;
  std::uint64_t groups = 0;
  std::uint64_t gears = 0;
  std::uint64_t streams = 0;
  std::uint64_t judged_streams = 0;
  std::uint64_t judged_gears = 0;
  std::string what;
};

TEST_F(MotionDefects, NotAtAllBreaksNothing) {
  seeds /= TAKT_PART_OF_SEEDS;
  EXPECT_FALSE(breaks({}, "")) << what;
  EXPECT_GT(motions, 100U);
  EXPECT_GT(arrivals, 20U);
  EXPECT_GT(groups, 0U);
  EXPECT_GT(gears, 0U);
  EXPECT_GT(streams, 0U);
  if (TAKT_PART_OF_SEEDS > 1) return;  // too few seeds for a gear that is compared
  EXPECT_GT(judged_streams, 0U);
  EXPECT_GT(judged_gears, 0U);
}

/// From point 5 on, the daemon gets each point with a time that is one cycle later.
TEST_F(MotionDefects, AStreamIsLateByACycle) {
  const auto late = [](motion_stream_t& stream) {
    std::int64_t number = stream.first_point;
    for (motion_point_t& point : stream.points) {
      if (number++ >= 5) point.time += 0.002;
    }
  };
  EXPECT_TRUE(breaks({.stream = late}, "a stream keeps to its path")) << what;
}

TEST_F(MotionDefects, AGearHasAnotherRatio) {
  const auto longer = [](motion_gear_t& gear) {
    for (double& numerator : gear.numerator) numerator *= 1 + 1e-4;
  };
  EXPECT_TRUE(breaks({.gear = longer}, "a gear keeps its ratio")) << what;
}

/// The daemon receives each motion with a timeout of 10 s. So the motion and its drive continue for
/// too long after the sender has fallen silent.
TEST_F(MotionDefects, ATimeoutLastsTooLong) {
  const auto longer =
      changed([](motion_command_t& command, const SeenCycles&) { command.timeout_ms = 10'000; });
  EXPECT_TRUE(breaks(longer, "no output is older than its time to live")) << what;
}

TEST_F(MotionDefects, AMotionIsFasterThanItsCommandAllows) {
  const auto faster = changed([](motion_command_t& command, const SeenCycles&) {
    for (motion_goal_t& goal : command.goals) goal.max_velocity *= 1.1;
  });
  EXPECT_TRUE(breaks(faster, "a motion keeps its limits")) << what;
}

TEST_F(MotionDefects, AMotionStartsWithAJump) {
  const auto harder = changed([](motion_command_t& command, const SeenCycles&) {
    for (motion_goal_t& goal : command.goals) {
      goal.max_acceleration *= 2;
      goal.max_jerk = goal.max_acceleration * 1000;
    }
  });
  EXPECT_TRUE(breaks(harder, "a motion keeps its limits")) << what;
}

/// The leader is often faster than the axis may be.
TEST_F(MotionDefects, AGearIsFasterThanItsCommandAllows) {
  const auto faster = [](motion_gear_t& gear) {
    for (motion_goal_t& goal : gear.goals) goal.max_velocity *= 1.3;
  };
  EXPECT_TRUE(breaks({.gear = faster}, "a motion keeps its limits")) << what;
}

/// A second program with the same name counts as the first one.
TEST_F(MotionDefects, ASenderIsAName) {
  const auto same = [](unsigned program, std::int64_t own) {
    return program == 7 || program == 0 ? 1 : own;
  };
  first = 130;
  EXPECT_TRUE(breaks({.instance = same}, "no sender moves what another holds")) << what;
}

TEST_F(MotionDefects, AGroupBeginsWithoutOneOfItsAxes) {
  const auto smaller = changed([](motion_command_t& command, const SeenCycles&) {
    if (command.kind != "move" || command.goals.size() < 2) return;
    command.goals.pop_back();
    command.num_goals = static_cast<std::int32_t>(command.goals.size());
  });
  EXPECT_TRUE(breaks(smaller, "a group begins in one cycle")) << what;
}

}  // namespace
}  // namespace takt::soak
