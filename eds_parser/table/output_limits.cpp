#include "eds_parser/table/output_limits.hpp"

#include <algorithm>

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

}  // namespace takt
