#include "eds_parser/plan/limits/limit_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

namespace takt {
namespace {

double number_of(const Signal& signal, std::int64_t raw) {
  if (signal.type == DataType::real32) {
    return double{std::bit_cast<float>(static_cast<std::uint32_t>(raw))};
  }
  if (signal.type == DataType::real64) return std::bit_cast<double>(raw);
  return static_cast<double>(raw);
}

}  // namespace

OutputLimit& LimitTable::row(SignalIndex signal) {
  auto& rows = plan_.limits.outputs;
  const auto found = std::ranges::find(rows, signal, &OutputLimit::signal);
  if (found != rows.end()) return *found;
  positions_.emplace_back();
  return rows.emplace_back(OutputLimit{.signal = signal});
}

void LimitTable::narrow(SignalIndex signal, RawBounds bounds, LimitKind kind, SourcePos pos) {
  OutputLimit& limit = row(signal);
  limit.low = std::max(limit.low, bounds.low);
  limit.high = std::min(limit.high, bounds.high);
  limit.range = kind;
  const auto place = static_cast<std::size_t>(&limit - plan_.limits.outputs.data());
  positions_[place] = pos;
}

RawBounds LimitTable::raw_bounds(SignalIndex index, std::optional<double> low,
                                 std::optional<double> high) const {
  const Signal& what = signal(index);
  const auto raw = [&what](double si) {
    const double counts = (si - what.offset) / what.scale;
    return is_real(what.type) ? counts : std::round(counts);
  };
  RawBounds bounds;
  if (what.scale < 0) std::swap(low, high);
  if (low) bounds.low = raw(*low);
  if (high) bounds.high = raw(*high);
  return bounds;
}

double LimitTable::raw_size(SignalIndex index, double si) const {
  return si / std::abs(signal(index).scale);
}

void LimitTable::finish() {
  auto& rows = plan_.limits.outputs;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Signal& what = signal(rows[i].signal);
    const auto outside = [&](std::int64_t raw) {
      const double value = number_of(what, raw);
      return value < rows[i].low || value > rows[i].high;
    };
    const std::string owner =
        what.name + " of node `" + plan_.nodes[what.node_index].name + "` lies outside its limits";
    if (what.safe_value && outside(*what.safe_value)) {
      report_.error(positions_[i], "limits", "the first value ", *what.safe_value,
                    " (`safe_values`, `sdo`, DCF) of ", owner);
    } else if (what.fallback == Fallback::value && outside(what.fallback_value)) {
      report_.error(positions_[i], "limits", "the value ", what.fallback_value,
                    " by `on_timeout` of ", owner);
    }
  }
  std::ranges::sort(rows, {}, &OutputLimit::signal);
}

}  // namespace takt
