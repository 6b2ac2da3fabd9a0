#include "master/core/kept_state.hpp"

#include <array>
#include <bitset>
#include <gtest/gtest.h>
#include <limits>
#include <optional>
#include <vector>

#include "master/core/node/duplicate_node_watch.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time end_of_times{std::int64_t{1} << 62};  // ns; beyond every clock

TEST(KeptTimes, CanBeSubtractedWhateverADamagedCheckpointHolds) {
  for (const std::int64_t count :
       {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::min() + 1,
        std::int64_t{-1} << 57}) {
    const std::array word{static_cast<std::uint64_t>(count)};
    Time time{};
    StateReader{word}(time);
    EXPECT_GT(time, -end_of_times) << count;
  }
}

TEST(KeptTimes, NeverAndOrdinaryTimesComeBackAsTheyWere) {
  for (const Time kept : {never, Time{}, Time{-10s}, Time{123456789}}) {
    const std::array word{static_cast<std::uint64_t>(kept.count())};
    Time time{1};
    StateReader{word}(time);
    EXPECT_EQ(time, kept);
  }
}

/// One value of each kind, at the limits of its range.
struct Extremes {
  double none = std::numeric_limits<double>::infinity();
  double below = -std::numeric_limits<double>::infinity();
  Time earliest = Time::min();
  Time latest = never;
  Time too_long{std::int64_t{1} << 60};
  int large = std::numeric_limits<int>::max();
  int small = std::numeric_limits<int>::min();
  std::int64_t wide = std::numeric_limits<std::int64_t>::min();
  std::uint16_t last = 7;  // beyond the end of its range
  Time period{};           // shorter than the shortest period
  std::optional<int> nothing{};
  std::optional<int> something{std::numeric_limits<int>::max()};
  std::bitset<3> bits{0b101};
  std::vector<char> text{'x', '\x80'};

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(none, below, earliest, latest, too_long, large, small, wide, nothing, something, bits,
          text);
    state.position(last, 4);
    state.period(period);
  }
  bool operator==(const Extremes&) const = default;
};

TEST(KeptValues, AreAsTheyWereAfterTheyHaveBeenSizedAndWritten) {
  Extremes running;
  StateSize size;
  size(running);
  EXPECT_EQ(running, Extremes{});
  std::vector<std::uint64_t> words(size.count());
  StateWriter{words.data()}(running);
  EXPECT_EQ(running, Extremes{});
}

TEST(KeptValues, ComeBackInfinite) {
  Extremes running;
  StateSize size;
  size(running);
  std::vector<std::uint64_t> words(size.count());
  StateWriter{words.data()}(running);
  Extremes restored{.none = 1.0, .below = 2.0, .nothing = 3, .something = 4, .bits = {}};
  StateReader{words}(restored);
  EXPECT_EQ(restored.none, std::numeric_limits<double>::infinity());
  EXPECT_EQ(restored.below, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(restored.nothing, std::nullopt);
  EXPECT_EQ(restored.bits, std::bitset<3>{0b101});
  EXPECT_EQ(restored.last, 0) << "only what is read is brought into its range";
}

TEST(KeptValues, AreNumbersWhateverADamagedCheckpointHolds) {
  const std::array word{std::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN())};
  double value = 1;
  StateReader{word}(value);
  EXPECT_EQ(value, 0);
}

TEST(KeptTimes, AWatchForTwinsReportsAtOnceAndThenOnceInTenSeconds) {
  DuplicateNodeWatch watch{100ms, CobId::base(0x605)};
  int reported = 0;
  for (Time now{}; now < 4s; now += 50ms) reported += watch.on_heartbeat(now).has_value();
  EXPECT_EQ(reported, 1) << "from the first second of the clock on";
}

}  // namespace
}  // namespace takt
