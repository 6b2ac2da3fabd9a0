#include "master/motion/entry.hpp"

#include <algorithm>
#include <cmath>

namespace takt::motion {
namespace {

/// The largest excess over a limit that counts as rounding, relative to the limit.
constexpr double limit_rounding = 1e-13;

/// Returns true if the velocity is above its limit, or exceeds it while the acceleration is reduced
/// to 0.
bool is_too_fast(const Transfer& t) noexcept {
  const double rise = std::max(t.start_acceleration, 0.0) * t.start_acceleration / 2;
  const double scale = t.max_velocity - t.min_velocity + rise;
  return t.start_velocity + rise > t.max_velocity + limit_rounding * scale;
}

bool is_too_steep(const Transfer& t) noexcept {
  return t.start_acceleration > t.max_acceleration * (1.0 + limit_rounding);
}

/// Returns the entry of a state for which is_too_fast() is true.
Entry slow_down(const Transfer& t) noexcept {
  const double v = t.start_velocity;
  const double a = t.start_acceleration;
  const double until_inside = a + std::sqrt(std::max(a * a + 2 * (v - t.max_velocity), 0.0));
  const double until_too_slow = a + std::sqrt(std::max(v + a * a / 2 - t.min_velocity, 0.0));
  const double until_limit = a - t.min_acceleration;
  const double jerk_time = std::max(std::min(until_inside, until_too_slow), 0.0);
  if (jerk_time <= until_limit) return {.jerk = -1.0, .duration = jerk_time, .hold = 0.0};
  const double limit = t.min_acceleration;
  const double start = std::max(until_limit, 0.0);
  const double reached = v + start * (a - start / 2);
  const double hold = std::min((t.max_velocity - reached) / limit,
                               (t.min_velocity + limit * limit / 2 - reached) / limit);
  return {.jerk = -1.0, .duration = start, .hold = std::max(hold, 0.0)};
}

/// Returns the entry of a state whose acceleration is too high, but whose velocity is not.
Entry ease_off(const Transfer& t) noexcept {
  const double limit = t.max_acceleration;
  const double time = t.start_acceleration - limit;
  const double reached = t.start_velocity + time * (t.start_acceleration - time / 2);
  const double hold = std::min((t.min_velocity - reached) / limit,
                               (t.max_velocity - limit * limit / 2 - reached) / limit);
  return {.jerk = -1.0, .duration = time, .hold = std::max(hold, 0.0)};
}

Entry entry_from_above(const Transfer& t) noexcept {
  if (is_too_fast(t)) return slow_down(t);
  if (is_too_steep(t)) return ease_off(t);
  return {};
}

}  // namespace

Entry entry(const Transfer& transfer) noexcept {
  // A velocity above its limit may fall so fast that it passes the lower limit before the
  // acceleration can reach 0.
  const double a = transfer.start_acceleration;
  const bool falls = transfer.start_velocity + a * std::abs(a) / 2 < transfer.min_velocity;
  const bool above = is_too_steep(transfer) ||
                     (!is_too_steep(mirrored(transfer)) && is_too_fast(transfer) && !falls);
  if (above) return entry_from_above(transfer);
  Entry below = entry_from_above(mirrored(transfer));
  below.jerk = -below.jerk;
  return below;
}

}  // namespace takt::motion
