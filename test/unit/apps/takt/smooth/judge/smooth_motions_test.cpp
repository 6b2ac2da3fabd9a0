// Motions that are as they should be, although they look unusual: they have no finding.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "test/unit/apps/takt/smooth/judge/generated_trace.hpp"

namespace takt::smooth {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

double in_seconds(Time t) { return 1e-9 * static_cast<double>(t.count()); }

/// Lets an axis follow another path; each set-point is for the SYNC that it precedes.
void follow(Generated& plan, std::size_t axis, const std::function<double(Time)>& path) {
  auto& sent = plan.axes[axis].sent;
  for (std::size_t k = 0; k < sent.size(); ++k) sent[k].value = path(plan.planned(k + 1));
}

/// Position of a motion with ramps of constant acceleration: from rest, over `ramp` to `velocity`,
/// and at `end` back to rest.
double trapezoid(double t, double ramp, double velocity, double end) {
  const double a = velocity / ramp;
  if (t < ramp) return t < 0 ? 0 : a * t * t / 2;
  if (t < end) return velocity * (t - ramp / 2);
  const double left = std::max(0.0, end + ramp - t);
  return velocity * (end - ramp / 2) + velocity * ramp / 2 - a * left * left / 2;
}

void expect_nothing(const Recipe& recipe, const Defect& change = {}) {
  const Verdict verdict = verdict_of(recipe, change);
  EXPECT_TRUE(verdict.findings.empty()) << findings_text(verdict);
  for (const AxisVerdict& axis : verdict.axes) {
    EXPECT_TRUE(axis.findings.empty()) << findings_text(verdict);
  }
}

TEST(SmoothMotion, MayBeACircleOfTwoAxes) {
  for (const int period : {1, 2, 4, 10}) {
    expect_nothing({.period = milliseconds{period}, .axes = 2}, [](Generated& plan) {
      for (const std::size_t axis : {0U, 1U}) {
        follow(plan, axis, [axis](Time t) {
          const double s = in_seconds(t);
          const double radius = 200'000 * std::min(1.0, s * s * (3 - 2 * std::min(1.0, s)));
          return radius * std::sin(3 * s + (axis == 0 ? 0 : std::numbers::pi / 2));
        });
      }
    });
  }
}

TEST(SmoothMotion, MayHaveConstantAcceleration) {
  for (const int period : {1, 2, 4, 10}) {
    expect_nothing({.period = milliseconds{period}}, [](Generated& plan) {
      follow(plan, 0, [](Time t) { return trapezoid(in_seconds(t) - 0.3, 0.15, 150'000, 1.2); });
    });
  }
}

TEST(SmoothMotion, MayCrossTheEndOfTheNumbers) {
  expect_nothing({}, [](Generated& plan) {
    const auto path = plan.axes[0].path;
    follow(plan, 0, [path](Time t) { return path(t) + 2'147'480'000.0; });
  });
}

TEST(SmoothMotion, MayHaveASetPointWithEverySecondSync) {
  expect_nothing({.period = milliseconds{2}, .interpolation = 2}, [](Generated& plan) {
    std::size_t number = 0;
    std::erase_if(plan.axes[0].sent, [&](const Sent&) { return number++ % 2 == 1; });
  });
}

TEST(SmoothMotion, MayBeginAndEndWhileOthersRest) {
  expect_nothing({.axes = 3},
                 [](Generated& plan) { follow(plan, 1, [](Time) { return 1234.0; }); });
}

TEST(SmoothMotion, MayHaveAPauseOfSync) {
  expect_nothing({}, [](Generated& plan) {
    // The master is started again in the rest between two motions.
    const Time from = milliseconds{600};
    const auto late = [&](Time& when) {
      when += when > from ? milliseconds{4000} : milliseconds{0};
    };
    std::ranges::for_each(plan.syncs, late);
    for (Sent& sent : plan.axes[0].sent) late(sent.when);
    std::fill(plan.axes[0].status.begin(), plan.axes[0].status.end(), 0x0637);
  });
}

TEST(SmoothMotion, MayEndWithTheAxisBeingDisabledAtRest) {
  expect_nothing({}, [](Generated& plan) {
    GeneratedAxis& axis = plan.axes[0];
    const std::size_t rest = 630;  // the axis stands still from 1.2 s to 1.3 s
    for (std::size_t k = rest; k < axis.status.size(); ++k) {
      axis.status[k] = 0x0250;
      axis.sent[k].value = axis.sent[rest].value;
    }
  });
}

TEST(SmoothMotion, IsFollowedByADriveWithItsUsualDelay) {
  for (const int period : {1, 2, 4, 10}) {
    for (const double delay : {0.1, 1.0, 2.5}) {
      expect_nothing({.period = milliseconds{period}, .delay_cycles = delay});
    }
  }
}

TEST(SmoothMotion, IsNotJudgedInProfilePosition) {
  expect_nothing({}, [](Generated& plan) {
    std::fill(plan.axes[0].mode.begin(), plan.axes[0].mode.end(), std::int8_t{1});
    follow(plan, 0, [](Time t) { return in_seconds(t) < 1 ? 0.0 : 100'000.0; });
  });
}

TEST(SmoothMotion, IsNotJudgedWhileTheDriveIsDisabled) {
  expect_nothing({}, [](Generated& plan) {
    std::fill(plan.axes[0].status.begin(), plan.axes[0].status.end(), std::uint16_t{0x0250});
    std::erase_if(plan.axes[0].sent, [&](const Sent&) { return plan.chance(0.1); });
  });
}

TEST(SmoothMotion, MayHaveTimeStampsOfATenthOfAMillisecond) {
  expect_nothing({.period = milliseconds{2}, .noise = 0.02, .sync_noise = 0}, [](Generated& plan) {
    const auto coarse = [](Time& when) { when -= when % microseconds{100}; };
    std::ranges::for_each(plan.syncs, coarse);
    for (Sent& sent : plan.axes[0].sent) coarse(sent.when);
  });
}

}  // namespace
}  // namespace takt::smooth
