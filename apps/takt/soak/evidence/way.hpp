#pragma once
#include <algorithm>
#include <chrono>
#include <cmath>

#include "eds_parser/values/time.hpp"

namespace takt::soak {

/// The distance from a value that was sent to the next one: its length in counts, and the greatest
/// number of cycles that it may have taken.
struct Way {
  double length = 0;
  unsigned cycles = 1;
};

/// Returns the greatest number of cycles that count for one distance.
inline double most_cycles_of_way(Time period) noexcept {
  constexpr Time longest_gap = std::chrono::milliseconds{50};
  constexpr double fewest_cycles = 3;
  return std::max(fewest_cycles, static_cast<double>(longest_gap / period));
}

/// Largest age, in cycles, of the knowledge that the master has of the state of an axis.
inline constexpr unsigned state_doubt = 8;

/// Returns the number of cycles from `from` to `to`, from 1 to `most`. A wake-up that is a little
/// late does not count.
inline unsigned cycles_between(Time from, Time to, Time period, double most) noexcept {
  constexpr double clear_part = 0.2;  // part of a cycle that a wake-up may be late
  const double cycles =
      static_cast<double>((to - from).count()) / static_cast<double>(period.count());
  const bool clear = std::abs(cycles - std::round(cycles)) <= clear_part;
  const double counted = clear ? std::round(cycles) : std::ceil(cycles);
  return static_cast<unsigned>(std::clamp(counted, 1.0, most));
}

/// Returns true if `way` after `last` needs more than the acceleration `bend`, in counts per cycle
/// squared. Each of the three values is rounded to a count, which may look like an acceleration. If
/// the same value was commanded again before, a distance over several cycles may have begun in any
/// of them.
inline bool is_too_sharp(double bend, const Way& way, const Way& last) noexcept {
  const auto sharp = [&](unsigned cycles, double before, unsigned gap) {
    const double found = std::abs(way.length / cycles - before);
    return found > bend * (cycles + gap) / 2 + 1.0 / cycles + 1.0 / gap + 1e-6;
  };
  for (unsigned cycles = 1; cycles <= way.cycles; ++cycles) {
    if (way.cycles > 1 && !sharp(cycles, 0, 1)) return false;
    for (unsigned gap = 1; gap <= last.cycles; ++gap) {
      if (!sharp(cycles, last.length / gap, gap)) return false;
    }
  }
  return true;
}

}  // namespace takt::soak
