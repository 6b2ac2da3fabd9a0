#include <gtest/gtest.h>

#include "apps/soak/image_judge.hpp"
#include "apps/soak/node_judge.hpp"
#include "apps/soak/output_judge.hpp"
#include "apps/soak/soak_jobs.hpp"
#include "test/unit/rt/small_plan.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

/// Two axes at 2 ms: 6041 and 6064 of both are signals 0 to 3, 6040 and 607A are 4 to 7.
class Judges : public testing::Test {
 protected:
  void hear(std::initializer_list<std::uint8_t> bytes) {
    images.on_wire({.frame = make_frame(CobId::base(0x181), bytes)});
  }
  void show(std::uint64_t cycle, std::int64_t word, std::int64_t position) {
    values[0] = word;
    values[2] = position;
    images.judge(
        {.cycle = cycle, .publish_time = Time{1ms} * cycle, .values = values, .stale_bits = {}});
  }

  BusPlan plan = test::axes({.fallback_cycles = 5});
  Verdict verdict;
  ImageJudge images{plan, verdict};
  OutputJudge outputs{plan, verdict};
  std::vector<std::int64_t> values = std::vector<std::int64_t>(8);
};

TEST_F(Judges, TakeAnImageWhoseValuesCameInOneFrame) {
  hear({0x37, 0x02, 0xFF, 0xFF, 0xFF, 0xFF});
  hear({0x27, 0x02, 0x05, 0x00, 0x00, 0x00});

  show(1, 0x0237, -1);
  show(2, 0x0227, 5);
  show(4, 0x0227, 5);

  EXPECT_TRUE(verdict.good());
}

TEST_F(Judges, BlameAnImageOfTwoFrames) {
  hear({0x37, 0x02, 0xFF, 0xFF, 0xFF, 0xFF});
  hear({0x27, 0x02, 0x05, 0x00, 0x00, 0x00});

  show(1, 0x0237, 5);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "no torn image");
}

TEST_F(Judges, BlameAnImageThatGoesBackToAnOlderFrame) {
  hear({0x37, 0x02, 0xFF, 0xFF, 0xFF, 0xFF});
  hear({0x27, 0x02, 0x05, 0x00, 0x00, 0x00});
  show(1, 0x0227, 5);

  show(2, 0x0237, -1);

  EXPECT_FALSE(verdict.good());
}

TEST_F(Judges, BlameACycleNumberThatStays) {
  show(7, 0, 0);
  show(7, 0, 0);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "cycle numbers rise");
}

TEST_F(Judges, BlameAControlwordBeyondItsTimeToLive) {
  const Frame enable = make_frame(CobId::base(0x201), {0x0F, 0x00, 0x00, 0x00, 0x00, 0x00});
  outputs.commanded(4, 0x000F, 3, 100ms);

  outputs.sent({&enable, 1}, 110ms);  // 5 periods
  EXPECT_TRUE(verdict.good());
  outputs.sent({&enable, 1}, 112ms);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "no stale output");
}

TEST_F(Judges, TakeAQuickStopWithoutACommand) {
  const Frame stop = make_frame(CobId::base(0x201), {0x02, 0x00, 0x00, 0x00, 0x00, 0x00});

  outputs.sent({&stop, 1}, 100ms);

  EXPECT_TRUE(verdict.good());
}

TEST_F(Judges, BlameTwoSyncsAtOnce) {
  const Frame sync = make_frame(CobId::base(0x080), {});

  outputs.sent({&sync, 1}, 100ms);
  outputs.sent({&sync, 1}, 100ms + 200us);

  ASSERT_FALSE(verdict.good());
  EXPECT_EQ(verdict.violation()->invariant, "no burst of SYNCs");
}

TEST(Soak, GivesTheSameRunForTheSameSeed) {
  const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/two_axes.yaml");

  const SoakOutcome first = soak(network, {.seed = 5, .duration = 3s});
  const SoakOutcome again = soak(network, {.seed = 5, .duration = 3s});
  const SoakOutcome other = soak(network, {.seed = 6, .duration = 3s});

  EXPECT_FALSE(first.violation);
  EXPECT_EQ(first.frames, again.frames);
  EXPECT_EQ(first.events, again.events);
  EXPECT_EQ(first.simulated, again.simulated);
  EXPECT_NE(first.frames, other.frames);
}

/// After a stall without SYNC a cycle was stamped with a beat that was still to come.
TEST(Soak, HoldsWhereAnotherDeviceMakesTheSync) {
  const LoadedNetwork network = load_network(TAKT_SOURCE_DIR "/share/demo/lenze8400_sync.yaml");

  for (std::uint64_t seed = 7030; seed <= 7040; ++seed) {
    const SoakOutcome outcome = soak(network, {.seed = seed, .duration = 20s});
    EXPECT_FALSE(outcome.violation) << seed;
  }
}

}  // namespace
}  // namespace takt
