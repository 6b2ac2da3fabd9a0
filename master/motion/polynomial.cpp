#include "master/motion/polynomial.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace takt::motion {
namespace {

/// Times between which a polynomial only rises or only falls: both ends of the interval, and its
/// extrema.
class Turns {
 public:
  void add(double time) noexcept { times_[size_++] = time; }
  std::span<const double> times() const noexcept { return std::span{times_}.first(size_); }

 private:
  std::array<double, 7> times_{};  // five zeros at most, and both ends
  std::size_t size_ = 0;
};

/// Returns the time at which the function changes its sign, which it does once.
double zero_between(const Polynomial& c, double low, double high) noexcept {
  const bool rises = value_at(c, high) > 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    ((value_at(c, middle) > 0.0) == rises ? high : low) = middle;
  }
  return (low + high) / 2;
}

/// Between two neighbouring turns of its derivative, the derivative has at most one zero.
Turns turns_of(const Polynomial& c, int degree, double duration) noexcept {
  Turns turns;
  turns.add(0.0);
  if (degree > 1) {
    const Polynomial slope = derivative_of(c);
    const Turns of_slope = turns_of(slope, degree - 1, duration);
    const auto times = of_slope.times();
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
      const bool before = value_at(slope, times[i]) > 0.0;
      const bool after = value_at(slope, times[i + 1]) > 0.0;
      if (before != after) turns.add(zero_between(slope, times[i], times[i + 1]));
    }
  }
  turns.add(duration);
  return turns;
}

}  // namespace

Polynomial quintic_between(const State& from, const State& to, double duration) noexcept {
  const double t = duration;
  const double way = to.position - from.position;
  const double v0 = from.velocity * t;
  const double v1 = to.velocity * t;
  const double a0 = from.acceleration * t * t;
  const double a1 = to.acceleration * t * t;
  const double cube = t * t * t;
  return {from.position,
          from.velocity,
          from.acceleration / 2,
          (20 * way - 8 * v1 - 12 * v0 - 3 * a0 + a1) / (2 * cube),
          (-30 * way + 14 * v1 + 16 * v0 + 3 * a0 - 2 * a1) / (2 * cube * t),
          (12 * way - 6 * v1 - 6 * v0 - a0 + a1) / (2 * cube * t * t)};
}

Polynomial cubic_between(const State& from, const State& to, double duration) noexcept {
  const double t = duration;
  const double way = to.position - from.position;
  const double v0 = from.velocity * t;
  const double v1 = to.velocity * t;
  return {from.position,
          from.velocity,
          (3 * way - 2 * v0 - v1) / (t * t),
          (-2 * way + v0 + v1) / (t * t * t),
          0.0,
          0.0};
}

Extremes extremes_of(const Polynomial& c, double duration) noexcept {
  Extremes found{.min = c[0], .max = c[0]};
  const Turns turns = turns_of(c, 5, duration);
  for (const double time : turns.times()) {
    found.min = std::min(found.min, value_at(c, time));
    found.max = std::max(found.max, value_at(c, time));
  }
  return found;
}

}  // namespace takt::motion
