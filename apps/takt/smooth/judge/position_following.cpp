#include "apps/takt/smooth/judge/position_following.hpp"

#include <cmath>
#include <limits>

#include "apps/takt/smooth/judge/numbers.hpp"

namespace takt::smooth {
namespace {

constexpr std::size_t longest_delay = 60;  // cycles

/// A cycle in motion: the position that the device sent in it.
struct Pair {
  std::size_t cycle = 0;
  std::int64_t position = 0;
};

/// Finds the first position of each cycle. Positions that come without relation to SYNC give no
/// velocities, so cycles with none or two positions are left out.
std::vector<Pair> pairs_of(const AxisRecord& axis, const AxisCycles& cycles) {
  std::vector<Pair> pairs;
  std::size_t next = 0;
  for (std::size_t i = 0; i + 1 < cycles.cycles.size(); ++i) {
    const Time begin = cycles.cycles[i].end;  // set-point i is in effect from here on
    const Time end = cycles.cycles[i + 1].end;
    while (next < axis.positions.size() && axis.positions[next].when < begin) ++next;
    std::size_t count = 0;
    const std::size_t first = next;
    while (next < axis.positions.size() && axis.positions[next].when < end) ++next, ++count;
    if (count == 1 && cycles.cycles[i].active) pairs.push_back({i, axis.positions[first].value});
  }
  return pairs;
}

void fit_delay(const AxisCycles& cycles, const std::vector<Pair>& pairs, Following& out) {
  double n = 0;
  double sv = 0;
  double se = 0;
  double svv = 0;
  double sve = 0;
  double see = 0;
  for (const Pair& pair : pairs) {
    if (pair.cycle < 4 || !cycles.cycles[pair.cycle].moving) continue;
    const auto& now = cycles.cycles[pair.cycle];
    const double v =
        static_cast<double>(difference(now.value, cycles.cycles[pair.cycle - 3].value)) / 3;
    const auto e = static_cast<double>(difference(now.value, pair.position));
    n += 1;
    sv += v;
    se += e;
    svv += v * v;
    sve += v * e;
    see += e * e;
  }
  out.cycles = static_cast<std::size_t>(n);
  if (n < 2) return;
  const double cvv = svv - sv * sv / n;
  const double cve = sve - sv * se / n;
  const double cee = see - se * se / n;
  if (cvv <= 0 || cee <= 0) return;
  const double slope = cve / cvv;  // cycles
  out.fit = cve * cve / (cvv * cee);
  out.delay = scaled(cycles.period, slope);
  out.error_at_peak = slope * cycles.peak;
}

/// Differences between the steps of the positions and those of the set-points `lag` cycles before.
std::vector<double> residuals(const AxisCycles& cycles, const std::vector<Pair>& pairs,
                              std::size_t lag) {
  std::vector<double> list;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const std::size_t at = pairs[i].cycle;
    if (pairs[i - 1].cycle + 1 != at || at <= lag + 1 || !cycles.clean(at - lag, at)) continue;
    const auto actual = static_cast<double>(difference(pairs[i].position, pairs[i - 1].position));
    list.push_back(actual - static_cast<double>(cycles.step(at - lag)));
  }
  return list;
}

double mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return values.empty() ? std::numeric_limits<double>::infinity()
                        : sum / static_cast<double>(values.size());
}

/// Returns the frequency at which the residuals repeat themselves, cycles^-1, or 0.
double repetition(const std::vector<double>& values) {
  const double whole = mean_square(values) * static_cast<double>(values.size());
  bool fell = false;
  double before = 1;
  double before_that = 1;
  for (std::size_t lag = 1; lag < values.size() / 4; ++lag) {
    double sum = 0;
    for (std::size_t i = lag; i < values.size(); ++i) sum += values[i] * values[i - lag];
    const double now = sum / whole;
    fell = fell || now < 0;
    if (fell && before > 0.4 && before > before_that && before >= now) {
      return 1.0 / static_cast<double>(lag - 1);
    }
    before_that = before;
    before = now;
  }
  return 0;
}

void fit_ripple(const AxisCycles& cycles, const std::vector<Pair>& pairs, Following& out) {
  std::vector<double> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t lag = 0; lag <= longest_delay; ++lag) {
    auto list = residuals(cycles, pairs, lag);
    if (list.size() < 50) break;
    if (const double square = mean_square(list); square < least) {
      least = square;
      best = std::move(list);
    }
  }
  if (best.empty() || cycles.peak == 0) return;
  // The positions are whole increments, so their steps have errors of rounding.
  const double rounding = 0.5;
  out.ripple_increments = std::sqrt(std::max(0.0, least - rounding * rounding));
  out.ripple = out.ripple_increments / cycles.peak;
  out.frequency = repetition(best) / seconds(cycles.period);
}

}  // namespace

Following following_of(const AxisRecord& axis, const AxisCycles& cycles) {
  Following out;
  const auto pairs = pairs_of(axis, cycles);
  fit_delay(cycles, pairs, out);
  fit_ripple(cycles, pairs, out);
  return out;
}

}  // namespace takt::smooth
