#include "apps/takt/smooth/judge/position_following.hpp"

#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "apps/takt/smooth/judge/numbers.hpp"

namespace takt::smooth {
namespace {

constexpr std::size_t longest_delay = 60;  // cycles
constexpr std::size_t newest_kept = 4000;  // residuals that show a frequency

/// A cycle in motion: the value that the device sent in it.
struct Pair {
  std::size_t cycle = 0;
  std::int64_t value = 0;
};

/// Finds the value of each cycle. Values that come without relation to SYNC can't be compared with
/// each other, so cycles with none or two of them are left out.
std::vector<Pair> pairs_of(const std::vector<Sample>& samples, const AxisCycles& cycles) {
  std::vector<Pair> pairs;
  std::size_t next = 0;
  for (std::size_t i = 0; i + 1 < cycles.cycles.size(); ++i) {
    const Time begin = cycles.cycles[i].end;  // set-point i is in effect from here on
    const Time end = cycles.cycles[i + 1].end;
    while (next < samples.size() && samples[next].when < begin) ++next;
    std::size_t count = 0;
    const std::size_t first = next;
    while (next < samples.size() && samples[next].when < end) ++next, ++count;
    if (count == 1 && cycles.cycles[i].active) pairs.push_back({i, samples[first].value});
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
    const auto e = static_cast<double>(difference(now.value, pair.value));
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

/// A velocity of the drive in a cycle: a step of its positions, or its 606C.
struct Velocity {
  std::size_t cycle = 0;
  double value = 0;
};

std::vector<Velocity> steps_of(const std::vector<Pair>& positions) {
  std::vector<Velocity> list;
  for (std::size_t i = 1; i < positions.size(); ++i) {
    if (positions[i - 1].cycle + 1 != positions[i].cycle) continue;
    const std::int64_t step = difference(positions[i].value, positions[i - 1].value);
    list.push_back({positions[i].cycle, static_cast<double>(step)});
  }
  return list;
}

std::vector<Velocity> velocities_of(const std::vector<Pair>& velocities) {
  std::vector<Velocity> list;
  for (const Pair& pair : velocities) list.push_back({pair.cycle, static_cast<double>(pair.value)});
  return list;
}

/// Differences between the velocities and those of the set-points `lag` cycles before.
struct Residuals {
  std::vector<double> values;
  double factor = 1;  // factor between the units of the two velocities
};

Residuals residuals(const AxisCycles& cycles, const std::vector<Velocity>& velocities,
                    std::size_t lag, bool own_unit) {
  Residuals out;
  std::vector<std::pair<double, double>> both;
  double sum = 0;
  double square = 0;
  for (const Velocity& velocity : velocities) {
    const std::size_t at = velocity.cycle;
    if (at <= lag + 1 || !cycles.clean(at - lag, at)) continue;
    const auto wanted = static_cast<double>(cycles.step(at - lag));
    both.emplace_back(velocity.value, wanted);
    sum += velocity.value * wanted;
    square += wanted * wanted;
  }
  if (own_unit && square > 0) out.factor = sum / square;
  for (const auto& [actual, wanted] : both) out.values.push_back(actual - out.factor * wanted);
  return out;
}

double mean_square(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return values.empty() ? std::numeric_limits<double>::infinity()
                        : sum / static_cast<double>(values.size());
}

/// Returns the frequency of a repetition in the residuals, in 1/cycle, or 0. Only the newest few
/// thousand residuals are used.
double repetition(std::span<const double> values) {
  values = values.last(std::min(values.size(), newest_kept));
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

void fit_ripple(const AxisCycles& cycles, const std::vector<Velocity>& velocities, bool own_unit,
                Following& out) {
  Residuals best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t lag = 0; lag <= longest_delay; ++lag) {
    auto found = residuals(cycles, velocities, lag, own_unit);
    if (found.values.size() < 50) break;
    if (const double square = mean_square(found.values); square < least) {
      least = square;
      best = std::move(found);
    }
  }
  const double peak = std::abs(best.factor) * cycles.peak;
  if (best.values.empty() || peak == 0) return;
  // The values are whole numbers, so each has a rounding error. A step of positions has two.
  const double rounding = 0.5;
  out.ripple_units = std::sqrt(std::max(0.0, least - rounding * rounding));
  out.ripple = out.ripple_units / peak;
  out.frequency = repetition(best.values) / seconds(cycles.period);
}

}  // namespace

Following following_of(const AxisRecord& axis, const AxisCycles& cycles) {
  Following out;
  const auto positions = pairs_of(axis.positions, cycles);
  fit_delay(cycles, positions, out);
  if (!positions.empty()) {
    fit_ripple(cycles, steps_of(positions), false, out);
  } else {
    fit_ripple(cycles, velocities_of(pairs_of(axis.velocities, cycles)), true, out);
    out.by_velocity = true;
  }
  return out;
}

}  // namespace takt::smooth
