#include "eds_parser/table/output_limits.hpp"

#include <algorithm>

#include "eds_parser/values/name_of.hpp"

namespace takt {

std::vector<LimitSum> sums_of(const LimitsPlan& limits, const LimitLine& line) {
  const auto holds_for = [&](SignalIndex signal) {
    return std::ranges::find(line.signals, signal) != line.signals.end();
  };
  std::vector<LimitSum> sums;
  for (const OutputLimit& row : limits.outputs) {
    if (!row.offset || !holds_for(row.signal) || !holds_for(*row.offset)) continue;
    sums.push_back({.target = row.signal, .offset = *row.offset});
  }
  return sums;
}

std::string_view name(LimitKind kind) noexcept {
  static constexpr std::string_view names[]{
      "position", "velocity", "acceleration", "jerk", "step", "torque", "range", "following_error"};
  return name_of(kind, names, "limit");
}

std::string_view name(LimitSource source) noexcept {
  static constexpr std::string_view names[]{"none", "file", "device"};
  return name_of(source, names, "none");
}

}  // namespace takt
