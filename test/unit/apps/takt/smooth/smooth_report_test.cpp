#include "apps/takt/smooth/smooth_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace takt::smooth {
namespace {

using testing::HasSubstr;

Verdict with(Gravity gravity) {
  Verdict verdict{.source = "trace.log", .length = std::chrono::seconds{2}};
  AxisVerdict axis{.name = "lift", .node = 5, .set_point = {0x607A, 0}, .moving = 100};
  axis.findings.push_back({.cause = Cause::skipped,
                           .gravity = gravity,
                           .text = "Two cycles got no set-point.",
                           .remedy = "Send them.",
                           .count = 2,
                           .first = std::chrono::milliseconds{250}});
  verdict.axes.push_back(axis);
  return verdict;
}

TEST(SmoothReport, NamesTheCauseAndTheRemedy) {
  const std::string text = verdict_text(with(Gravity::error));

  EXPECT_THAT(text, HasSubstr("trace.log, 2.000 s: 1 rough, 0 with a warning"));
  EXPECT_THAT(
      text,
      HasSubstr("lift: error [skipped]\n  Two cycles got no set-point.\n  Remedy: Send them.\n"));
}

TEST(SmoothReport, CountsAnAxisWithWarningsSeparately) {
  EXPECT_THAT(verdict_text(with(Gravity::warning)), HasSubstr("0 rough, 1 with a warning"));
}

TEST(SmoothReport, HasTheFindingInJson) {
  const auto json = verdict_json(with(Gravity::error));

  EXPECT_EQ(json["rough"], true);
  EXPECT_EQ(json["axes"][0]["findings"][0]["cause"], "skipped");
  EXPECT_EQ(json["axes"][0]["findings"][0]["first_s"], 0.25);
  EXPECT_EQ(json["axes"][0]["interpolation_us"], nullptr);
  EXPECT_EQ(verdict_json(with(Gravity::warning))["rough"], false);
}

TEST(SmoothReport, PutsErrorsBeforeWarningsAndFundamentalCausesFirst) {
  std::vector<Finding> findings{{.cause = Cause::no_sync, .gravity = Gravity::warning},
                                {.cause = Cause::late},
                                {.cause = Cause::two_senders}};

  sort_findings(findings);

  EXPECT_EQ(findings[0].cause, Cause::two_senders);
  EXPECT_EQ(findings[1].cause, Cause::late);
  EXPECT_EQ(findings[2].cause, Cause::no_sync);
}

}  // namespace
}  // namespace takt::smooth
