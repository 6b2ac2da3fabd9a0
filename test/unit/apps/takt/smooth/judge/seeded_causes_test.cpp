// Each cause of roughness is put into a smooth motion, and the first finding has to name it: at
// several periods, numbers of axes, seeds and noises. Smooth motions have no findings.
#include "test/unit/apps/takt/smooth/judge/seeded_causes.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/unit/apps/takt/smooth/judge/generated_trace.hpp"

namespace takt::smooth {
namespace {

using std::chrono::milliseconds;

/// Returns the first finding of the recording: of SYNC, otherwise of the first axis.
const Finding* first_finding(const Verdict& verdict) {
  if (!verdict.findings.empty()) return verdict.findings.data();
  if (verdict.axes.empty() || verdict.axes[0].findings.empty()) return nullptr;
  return verdict.axes[0].findings.data();
}

std::vector<Recipe> recipes() {
  std::vector<Recipe> list;
  std::uint32_t seed = 0;
  for (const int period_ms : {1, 2, 4, 10}) {
    for (const unsigned axes : {1U, 3U}) {
      for (const double noise : {0.005, 0.04}) {
        ++seed;
        list.push_back({.period = milliseconds{period_ms},
                        .axes = axes,
                        .seed = seed,
                        .boot = seed % 2 == 0,
                        .noise = noise});
      }
    }
  }
  return list;
}

std::string told(const Recipe& recipe) {
  return fmt::format("{} ms, {} axes, seed {}, noise {}, {}", recipe.period / milliseconds{1},
                     recipe.axes, recipe.seed, recipe.noise,
                     recipe.boot ? "with boot" : "without boot");
}

class SeededCause : public testing::TestWithParam<std::size_t> {};

TEST_P(SeededCause, IsTheFirstFinding) {
  const Seeded& seeded = seeded_causes()[GetParam()];
  for (Recipe recipe : recipes()) {
    recipe.boot = recipe.boot || seeded.needs_boot;
    if (seeded.recipe) seeded.recipe(recipe);
    if (seeded.cause == Cause::interpolation_unset && recipe.period == milliseconds{1})
      continue;  // 1 ms is the default

    const Verdict verdict = verdict_of(recipe, seeded.defect);

    const Finding* const first = first_finding(verdict);
    ASSERT_NE(first, nullptr) << seeded.name << ": " << told(recipe) << '\n'
                              << findings_text(verdict);
    EXPECT_EQ(name_of(first->cause), std::string{name_of(seeded.cause)})
        << seeded.name << ": " << told(recipe) << '\n'
        << findings_text(verdict);
  }
}

INSTANTIATE_TEST_SUITE_P(Smooth, SeededCause, testing::Range<std::size_t>(0, 37));

TEST(SmoothMotion, HasNoFinding) {
  for (Recipe recipe : recipes()) {
    for (const double size : {0.3, 1.0, 10.0}) {
      recipe.size = size;
      recipe.seed += 100;

      const Verdict verdict = verdict_of(recipe);

      EXPECT_EQ(first_finding(verdict), nullptr) << told(recipe) << '\n' << findings_text(verdict);
      for (const AxisVerdict& axis : verdict.axes)
        EXPECT_TRUE(axis.findings.empty()) << findings_text(verdict);
      ASSERT_FALSE(verdict.axes.empty());
      EXPECT_GT(verdict.axes[0].moving, 300U);
    }
  }
}

}  // namespace
}  // namespace takt::smooth
