#include "apps/takt/soak/front_run.hpp"

#include <array>
#include <gtest/gtest.h>
#include <memory>
#include <string>

namespace takt::soak {
namespace {

using namespace std::chrono_literals;

LoadedNetwork demo() { return load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml"); }

TEST(FrontSoak, GivesTheSameRunForTheSameSeed) {
  const LoadedNetwork network = demo();

  const SoakOutcome first = soak_front(network, {.seed = 5, .duration = 3s});
  const SoakOutcome again = soak_front(network, {.seed = 5, .duration = 3s});
  const SoakOutcome other = soak_front(network, {.seed = 7, .duration = 3s});

  EXPECT_FALSE(first.violation);
  EXPECT_GT(first.moves, 1000U);
  EXPECT_EQ(first.commands, again.commands);
  EXPECT_EQ(first.moves, again.moves);
  EXPECT_EQ(first.forged, again.forged);
  EXPECT_EQ(first.events, again.events);
  EXPECT_EQ(first.simulated, again.simulated);
  EXPECT_NE(first.commands, other.commands);
}

/// Each run disables one safety function of takt, and a judge must report this.
class FrontDefects : public testing::Test {
 protected:
  std::uint64_t first = 1;
  std::uint64_t seeds = 12;

  /// Returns the first invariant that one of the seeds breaks; empty if none does.
  std::string broken(const FrontDefect& defect) {
    for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
      const SoakOutcome outcome =
          soak_front(network, {.seed = seed, .duration = 20s, .front = defect});
      if (!outcome.violation) continue;
      RecordProperty("seed", static_cast<int>(seed));
      RecordProperty("what", outcome.violation->what);
      what = outcome.violation->what;
      return outcome.violation->invariant;
    }
    return "";
  }

  LoadedNetwork network = demo();
  std::string what;
};

TEST_F(FrontDefects, NotAtAllBreaksNothing) {
  seeds /= TAKT_PART_OF_SEEDS;
  EXPECT_EQ(broken({}), "");
}

/// A second program with the same name counts as the first one.
TEST_F(FrontDefects, ASenderIsAName) {
  const auto same = [](unsigned program, std::int64_t own) {
    return program == 7 ? 1 : program == 0 ? 1 : own;
  };
  EXPECT_EQ(broken({.instance = same}), "no sender moves what another holds");
}

TEST_F(FrontDefects, OutputsHaveNoLimits) {
  EXPECT_EQ(broken({.plan = [](BusPlan& plan) { plan.limits = {}; }}),
            "no output leaves its limits");
}

/// Each axis of the network has one kind of limit, which the master does not check.
class LimitDefects : public FrontDefects {
 protected:
  LimitDefects() {
    network = load_network(TAKT_SOURCE_DIR "/test/soak/data/limited.yaml");
    seeds = 60;  // an application seldom jumps
  }

  /// Returns the report of the judge if the bus thread lacks one number of the limits of this
  /// object.
  std::string unchecked(std::uint16_t object, double OutputLimit::* number) {
    const auto forget = [=](BusPlan& plan) {
      for (OutputLimit& limit : plan.limits.outputs) {
        if (plan.layout.signals[limit.signal].object.index != object) continue;
        limit.*number = number == &OutputLimit::low ? -OutputLimit::none : OutputLimit::none;
        if (number == &OutputLimit::low) limit.high = OutputLimit::none;
      }
    };
    return broken({.plan = forget}) == "no output leaves its limits"
               ? what
               : "not the judge of limits: " + what;
  }
  void expect(const std::string& reported, const char* output, const char* kind) {
    EXPECT_TRUE(reported.starts_with(output)) << reported;
    EXPECT_NE(reported.find(std::string{"breaks the limit of "} + kind + ":"), std::string::npos)
        << reported;
  }
};

TEST_F(LimitDefects, NotAtAllBreaksNothing) {
  seeds /= TAKT_PART_OF_SEEDS;
  EXPECT_EQ(broken({}), "") << what;
}
TEST_F(LimitDefects, PositionsHaveNoRange) {
  expect(unchecked(0x607A, &OutputLimit::low), "ranged.", "position");
}
TEST_F(LimitDefects, StepsHaveNoLimit) {
  expect(unchecked(0x607A, &OutputLimit::step), "stepped.", "step");
}
TEST_F(LimitDefects, PositionsHaveNoLimitOfVelocity) {
  // Two axes have this number; `spun` uses it to limit target velocities.
  const std::string reported = unchecked(0x607A, &OutputLimit::rate);
  const bool spun = reported.starts_with("spun.");
  expect(reported, spun ? "spun.target_position" : "paced.target_position", "velocity");
}
TEST_F(LimitDefects, PositionsHaveNoLimitOfAcceleration) {
  expect(unchecked(0x607A, &OutputLimit::bend), "bent.", "acceleration");
}
TEST_F(LimitDefects, TargetVelocitiesHaveNoLimit) {
  expect(unchecked(0x60FF, &OutputLimit::low), "spun.", "velocity");
}
TEST_F(LimitDefects, TorquesHaveNoLimit) {
  expect(unchecked(0x6071, &OutputLimit::low), "pushed.", "torque");
}

/// The limits of each axis hold for the sum of a target and its offset. The master does not add the
/// offset.
class SumDefects : public LimitDefects {
 protected:
  SumDefects() { network = load_network(TAKT_SOURCE_DIR "/test/soak/data/summed.yaml"); }

  std::string unadded(std::uint16_t object) {
    const auto forget = [=](BusPlan& plan) {
      for (OutputLimit& limit : plan.limits.outputs) {
        if (plan.layout.signals[limit.signal].object.index == object) limit.offset.reset();
      }
    };
    return broken({.plan = forget}) == "no output leaves its limits"
               ? what
               : "not the judge of limits: " + what;
  }
};

TEST_F(SumDefects, NotAtAllBreaksNothing) {
  seeds /= TAKT_PART_OF_SEEDS;
  EXPECT_EQ(broken({}), "") << what;
}
TEST_F(SumDefects, PositionOffsetsAreNotAdded) { expect(unadded(0x607A), "shifted.", "step"); }
TEST_F(SumDefects, VelocityOffsetsAreNotAdded) { expect(unadded(0x60FF), "spun.", "velocity"); }

/// The front thread predicts the next image only after it has looked for images.
TEST_F(FrontDefects, TheFrontThreadSleepsOverAnImage) {
  const auto late = [](FrontRound& round) {
    round.wait = [predict = round.next_image, wait = round.wait](Time, Time latest) {
      wait(predict(), latest);
    };
    round.next_image = [] { return Time{}; };
  };
  EXPECT_EQ(broken({.round = late}), "each wait of the front thread ends in time");
}

/// The daemon counts the age of a command up to the newest image instead of up to now, so commands
/// do not age while images stay away.
TEST_F(FrontDefects, AgesEndAtTheNewestImage) {
  const auto younger = [](command_t& command, const SeenCycles& cycles) {
    command.cycle += cycles.now - cycles.newest;
  };
  EXPECT_EQ(broken({.command = younger}), "no output is older than its time to live");
}

/// A command that is computed from no image counts as computed from the newest one.
TEST_F(FrontDefects, ACommandFromNoCycleIsTaken) {
  const auto from_none = [](command_t& command, const SeenCycles& cycles) {
    if (command.cycle < 1) command.cycle = cycles.newest;
  };
  EXPECT_EQ(broken({.command = from_none}), "no output is older than its time to live");
}

/// A command that is computed from an image to come counts as computed from the newest one.
TEST_F(FrontDefects, ACommandFromTheFutureIsTaken) {
  const auto from_future = [](command_t& command, const SeenCycles& cycles) {
    if (command.cycle > cycles.now + 1) command.cycle = cycles.newest;
  };
  first = 20;
  EXPECT_EQ(broken({.command = from_future}), "no output is older than its time to live");
}

/// The seeds that find these defects find nothing if the commands are only read.
TEST_F(FrontDefects, ReadingEachCommandBreaksNothing) {
  seeds = 1;
  for (const std::uint64_t seed : {1U, 3U, 20U}) {
    first = seed;
    std::int64_t read = 0;
    EXPECT_EQ(broken({.command = [&](command_t&, const SeenCycles&) { ++read; }}), "") << what;
    EXPECT_GT(read, 1000) << seed;
  }
}

/// A command is valid for as long as it asks, even for years: the network file does not limit this
/// time. The programs of the run ask for 8 cycles and more.
TEST_F(FrontDefects, TheTimeToLiveHasNoLimit) {
  const auto limit = [](BusPlan& plan, std::uint32_t cycles) {
    for (Signal& signal : plan.layout.signals) {
      if (signal.output) signal.fallback_cycles = cycles;
    }
  };
  const auto for_years = [](command_t& command, const SeenCycles&) {
    command.time_to_live = 0x7FFF'FFFF;
  };
  limit(network.plan, 6);
  EXPECT_EQ(broken({.command = for_years}), "") << what;
  EXPECT_EQ(
      broken({.plan = [&](BusPlan& plan) { limit(plan, 0x7FFF'FFFF); }, .command = for_years}),
      "no output is older than its time to live");
}

/// A program ignores images that are older than the newest cycle that it has received.
TEST_F(FrontDefects, OneForgedImageDeafensAProgram) {
  std::array<std::int64_t, 8> newest{};
  const auto hears = [&newest](unsigned program, const image_t& image) {
    if (image.cycle < newest[program]) return false;
    newest[program] = image.cycle;
    return true;
  };
  EXPECT_EQ(broken({.hears = hears}), "no message stops a program from using images");
}

/// Any velocity counts as standstill, so axes are disabled while they brake, and the stop is
/// confirmed.
TEST_F(FrontDefects, NothingIsSeenOfTheStop) {
  network = load_network(TAKT_SOURCE_DIR "/test/soak/data/slow_stop.yaml");
  EXPECT_EQ(broken({}), "");
  const auto blind = [](BusPlan& plan) {
    for (NodePlan& node : plan.nodes) {
      for (AxisPlan& axis : node.axes) {
        axis.velocity_window = 1'000'000'000;
        axis.position_window = 1'000'000'000;
      }
    }
  };
  EXPECT_EQ(broken({.plan = blind}), "no stop confirms more than was seen");
}

}  // namespace
}  // namespace takt::soak
