#include "apps/plot/ticks.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace takt {
namespace {

/// Numbers outside of these powers of ten are written with an exponent.
constexpr double most_digits_after = 6.0;
constexpr double most_digits_before = 6.0;
/// A range that is narrower than this part of its values counts as a rounding error.
constexpr double narrowest = 1e-9;

double round_step(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (step <= factor * power * 1.0001) return factor * power;
  }
  return 10.0 * power;
}

}  // namespace

std::string Ticks::text(double value) const {
  if (std::abs(value) < step / 2.0) return "0";
  const double digits = -std::floor(std::log10(step) + 1e-9);
  const double before = std::log10(std::abs(value));
  if (digits > most_digits_after || before >= most_digits_before)
    return fmt::format("{:.4g}", value);
  return fmt::format("{:.{}f}", value, std::max(0, static_cast<int>(digits)));
}

Ticks enclosing_ticks(double low, double high, int wanted) {
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low <= size * narrowest) {
    const double half = size > 0.0 ? size * 0.1 : 1.0;
    low -= half;
    high += half;
  }
  Ticks ticks;
  ticks.step = round_step((high - low) / wanted);
  const double first = std::floor(low / ticks.step + 1e-6);
  const double last = std::ceil(high / ticks.step - 1e-6);
  for (double i = first; i <= last; ++i) ticks.values.push_back(i * ticks.step);
  return ticks;
}

}  // namespace takt
