#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "eds_parser/values/time.hpp"

namespace takt::smooth {

/// Returns the value below which the share `part` (0..1) of all values is, or 0 if there are no
/// values.
template <class T>
T quantile(std::vector<T> values, double part) {
  if (values.empty()) return T{};
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + at);
  return values[static_cast<std::size_t>(at)];
}

template <class T>
T median(std::vector<T> values) {
  return quantile(std::move(values), 0.5);
}

/// Returns a quotient of two times.
constexpr double ratio(Time a, Time b) noexcept {
  return static_cast<double>(a.count()) / static_cast<double>(b.count());
}

constexpr Time scaled(Time time, double factor) noexcept {
  return Time{static_cast<std::int64_t>(static_cast<double>(time.count()) * factor)};
}

constexpr Time distance(Time a, Time b) noexcept { return a < b ? b - a : a - b; }

constexpr double ms(Time time) noexcept { return 1e-6 * static_cast<double>(time.count()); }
constexpr double seconds(Time time) noexcept { return 1e-9 * static_cast<double>(time.count()); }

/// Returns "once", or for example "3 times".
inline std::string times_text(std::uint64_t count) {
  return count == 1 ? "once" : std::to_string(count) + " times";
}

/// Returns for example "1 cycle" or "3 cycles".
inline std::string counted(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace takt::smooth
