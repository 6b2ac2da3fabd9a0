#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <fmt/format.h>
#include <limits>

#include "apps/takt/smooth/judge/judges.hpp"
#include "apps/takt/smooth/judge/numbers.hpp"

namespace takt::smooth {
namespace {

constexpr int most_lag = 6;           // cycles
constexpr std::size_t margin = 12;    // cycles at rest on both sides of a motion
constexpr std::size_t shortest = 30;  // cycles
constexpr std::size_t fewest_motions = 2;

/// A motion from standstill to standstill: cycles [first, last].
struct Motion {
  std::size_t first = 0;
  std::size_t last = 0;
};

std::vector<Motion> motions_of(const AxisCycles& cycles) {
  std::vector<Motion> list;
  std::size_t still = 0;
  std::optional<std::size_t> first;
  std::size_t last = 0;
  for (std::size_t i = 1; i < cycles.cycles.size(); ++i) {
    const bool moves = cycles.cycles[i].active && cycles.step(i) != 0;
    if (moves) {
      if (!first && still >= margin) first = i;
      last = i;
      still = 0;
    } else if (++still == margin && first) {
      if (last - *first >= shortest) list.push_back({*first, last});
      first.reset();
    }
  }
  return list;
}

/// A measure of how well the steps of `b`, `lag` cycles earlier, explain those of `a` in a motion.
struct Fit {
  double residual = std::numeric_limits<double>::infinity();  // increments
  double factor = 0;
};

Fit fit_of(const AxisCycles& a, const AxisCycles& b, Motion motion, int lag) {
  double ab = 0;
  double aa = 0;
  double bb = 0;
  double n = 0;
  for (std::size_t i = motion.first - margin / 2; i <= motion.last + margin / 2; ++i) {
    const auto k = static_cast<std::ptrdiff_t>(i) - lag;
    if (i < 1 || k < 1 || i >= a.cycles.size() || k >= std::ssize(b.cycles)) return {};
    const auto x = static_cast<double>(a.step(i));
    const auto y = static_cast<double>(b.step(static_cast<std::size_t>(k)));
    ab += x * y;
    aa += x * x;
    bb += y * y;
    n += 1;
  }
  if (aa <= 0 || bb <= 0) return {};
  const double factor = ab / bb;
  return {std::sqrt(std::max(0.0, aa - factor * ab) / n), factor};
}

/// Returns by how many cycles `a` is behind `b` in this motion, or std::nullopt if `b` does not
/// make a motion of the same shape.
std::optional<int> lag_of(const AxisCycles& a, const AxisCycles& b, Motion motion) {
  Fit best;
  int at = 0;
  for (int lag = -most_lag; lag <= most_lag; ++lag) {
    const Fit fit = fit_of(a, b, motion, lag);
    if (fit.residual >= best.residual) continue;
    best = fit;
    at = lag;
  }
  const double rounding = 0.6 * (1 + std::abs(best.factor));
  if (best.residual > std::max(rounding, 0.004 * a.peak) || std::abs(at) == most_lag) return {};
  const bool clear = fit_of(a, b, motion, 0).residual > 1.5 * best.residual;
  return at != 0 && !clear ? std::optional{0} : std::optional{at};
}

std::optional<int> common_lag(const AxisCycles& a, const AxisCycles& b) {
  std::optional<int> common;
  std::size_t seen = 0;
  for (const Motion& motion : motions_of(a)) {
    const auto lag = lag_of(a, b, motion);
    if (!lag || (common && *common != *lag)) return {};
    common = lag;
    ++seen;
  }
  return seen >= fewest_motions ? common : std::nullopt;
}

bool have_one_grid(const AxisView& a, const AxisView& b) {
  return a.cycles.by_sync && b.cycles.by_sync && a.cycles.stride == 1 && b.cycles.stride == 1;
}

}  // namespace

void judge_group(const std::vector<AxisView>& axes, std::vector<Findings>& findings) {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (std::size_t k = 0; k < axes.size(); ++k) {
      if (i == k || !have_one_grid(axes[i], axes[k])) continue;
      const auto lag = common_lag(axes[i].cycles, axes[k].cycles);
      if (!lag || *lag <= 0) continue;
      findings[i].push_back(
          {.cause = Cause::lag_in_group,
           .gravity = Gravity::warning,
           .text = fmt::format("This axis makes the same motions as {}, but its set-points come {} "
                               "cycles later ({:.3f} ms).",
                               axes[k].axis.name, *lag, ms(axes[i].cycles.period * *lag)),
           .remedy = "If both belong to one path, compute their set-points from one image and send "
                     "them before the same SYNC."});
      break;
    }
  }
}

}  // namespace takt::smooth
