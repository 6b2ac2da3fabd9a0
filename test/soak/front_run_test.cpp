#include "apps/soak/front_run.hpp"

#include <array>
#include <gtest/gtest.h>
#include <memory>
#include <string>

namespace takt {
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
class FrontMeddled : public testing::Test {
 protected:
  std::uint64_t seeds = 12;

  /// Returns the first invariant that one of the seeds breaks; empty if none does.
  std::string broken(const FrontMeddle& meddle) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const SoakOutcome outcome =
          soak_front(network, {.seed = seed, .duration = 20s, .front = meddle});
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

TEST_F(FrontMeddled, NotAtAllBreaksNothing) { EXPECT_EQ(broken({}), ""); }

/// A second program with the same name counts as the first one.
TEST_F(FrontMeddled, ASenderIsAName) {
  const auto same = [](unsigned program, std::int64_t own) {
    return program == 7 ? 1 : program == 0 ? 1 : own;
  };
  EXPECT_EQ(broken({.instance = same}), "no sender moves what another holds");
}

TEST_F(FrontMeddled, OutputsHaveNoLimits) {
  EXPECT_EQ(broken({.plan = [](BusPlan& plan) { plan.limits = {}; }}),
            "no output leaves its limits");
}

/// Each axis of the network has one kind of limit, which the master does not check.
class LimitMeddled : public FrontMeddled {
 protected:
  LimitMeddled() {
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
  void expect(const std::string& told, const char* output, const char* kind) {
    EXPECT_TRUE(told.starts_with(output)) << told;
    EXPECT_NE(told.find(std::string{"breaks the limit of "} + kind + ":"), std::string::npos)
        << told;
  }
};

TEST_F(LimitMeddled, NotAtAllBreaksNothing) { EXPECT_EQ(broken({}), "") << what; }
TEST_F(LimitMeddled, PositionsHaveNoRange) {
  expect(unchecked(0x607A, &OutputLimit::low), "ranged.", "position");
}
TEST_F(LimitMeddled, StepsHaveNoLimit) {
  expect(unchecked(0x607A, &OutputLimit::step), "stepped.", "step");
}
TEST_F(LimitMeddled, PositionsHaveNoLimitOfVelocity) {
  // Two axes have this number; `spun` uses it to limit target velocities.
  const std::string told = unchecked(0x607A, &OutputLimit::rate);
  const bool spun = told.starts_with("spun.");
  expect(told, spun ? "spun.target_position" : "paced.target_position", "velocity");
}
TEST_F(LimitMeddled, PositionsHaveNoLimitOfAcceleration) {
  expect(unchecked(0x607A, &OutputLimit::bend), "bent.", "acceleration");
}
TEST_F(LimitMeddled, TargetVelocitiesHaveNoLimit) {
  expect(unchecked(0x60FF, &OutputLimit::low), "spun.", "velocity");
}
TEST_F(LimitMeddled, TorquesHaveNoLimit) {
  expect(unchecked(0x6071, &OutputLimit::low), "pushed.", "torque");
}

/// The front thread predicts the next image only after it has looked for images.
TEST_F(FrontMeddled, TheFrontThreadSleepsOverAnImage) {
  const auto late = [](FrontRound& round) {
    round.wait = [predict = round.next_image, wait = round.wait](Time, Time latest) {
      wait(predict(), latest);
    };
    round.next_image = [] { return Time{}; };
  };
  EXPECT_EQ(broken({.round = late}), "each wait of the front thread ends in time");
}

/// A program ignores images that are older than the newest cycle that it has received.
TEST_F(FrontMeddled, OneForgedImageDeafensAProgram) {
  std::array<std::int64_t, 8> newest{};
  const auto hears = [&newest](unsigned program, const image_t& image) {
    if (image.cycle < newest[program]) return false;
    newest[program] = image.cycle;
    return true;
  };
  EXPECT_EQ(broken({.hears = hears}), "no message deafens an application");
}

/// Any velocity counts as standstill, so axes are disabled while they brake, and the stop is
/// confirmed.
TEST_F(FrontMeddled, NothingIsSeenOfTheStop) {
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
  EXPECT_EQ(broken({.plan = blind}), "no stop claims more than was seen");
}

}  // namespace
}  // namespace takt
