// A recording may contain anything. `takt smooth` must judge it without a crash.
#include <gtest/gtest.h>
#include <random>

#include "apps/takt/smooth/judge/smooth_verdict.hpp"

namespace takt::smooth {
namespace {

class AnyRecording {
 public:
  explicit AnyRecording(std::uint32_t seed) : random_{seed} {}

  BusRecord make() {
    BusRecord bus{.source = "any", .resolution = Time{1}, .bitrate = below(2) * 500'000};
    bus.syncs = times();
    for (const Time when : times()) bus.frames.push_back({when, 100});
    for (unsigned i = below(3); i != 0; --i) {
      bus.axes.push_back({.name = "axis", .node = static_cast<std::uint8_t>(i)});
      AxisRecord& axis = bus.axes.back();
      axis.set_points = samples(0xFFFF'FFFF);
      axis.positions = samples(0xFFFF'FFFF);
      axis.velocities = samples(1000);
      axis.statuswords = samples(0xFFFF);
      axis.controlwords = samples(0xFFFF);
      if (below(2) == 0) axis.modes = samples(10);
      if (below(2) == 0) axis.statuswords.clear();
      if (below(2) == 0) axis.positions.clear();
      if (below(2) == 0) axis.settings.interpolation = Time{below(3) * 1'000'000};
    }
    return bus;
  }

 private:
  std::uint32_t below(std::uint32_t limit) { return static_cast<std::uint32_t>(random_() % limit); }

  std::vector<Time> times() {
    constexpr std::uint32_t steps[]{1, 1000, 2'000'000, 4'000'000'000};
    std::vector<Time> list;
    Time when{};
    const std::uint32_t longest = steps[below(4)];
    for (std::uint32_t i = below(200); i != 0; --i) {
      when += Time{1 + (below(3) == 0 ? longest / 2 : below(longest))};
      list.push_back(when);
    }
    return list;
  }

  std::vector<Sample> samples(std::uint32_t largest) {
    std::vector<Sample> list;
    std::int64_t value = 0;
    const bool rising = below(2) == 0;
    for (const Time when : times()) {
      value = rising ? value + 1000 : static_cast<std::int32_t>(below(largest));
      list.push_back({when, value});
    }
    return list;
  }

  std::mt19937 random_;
};

TEST(AnyRecording, IsJudged) {
  for (std::uint32_t seed = 0; seed < 3000; ++seed) {
    const BusRecord bus = AnyRecording{seed}.make();

    EXPECT_EQ(judge(bus).axes.size(), bus.axes.size());
  }
}

}  // namespace
}  // namespace takt::smooth
