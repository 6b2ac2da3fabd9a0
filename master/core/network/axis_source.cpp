#include "master/core/network/axis_source.hpp"

#include <algorithm>
#include <utility>

namespace takt {
namespace {

/// Returns the longest time between two frames of a TPDO while its values change, according to the
/// plan.
Time distance_of(const BusPlan& plan, const PdoRow& row) {
  if (row.cyclic()) return static_cast<Time::rep>(row.transmission) * plan.cycle.period;
  return std::max(row.inhibit, row.event_timer);
}

bool is_stale(SignalIndex signal, const ReceivedValues& received) noexcept {
  return (received.stale[signal / 64U] >> (signal % 64U) & 1U) != 0;
}

}  // namespace

AxisSource::AxisSource(const BusPlan& plan, std::optional<SignalIndex> signal) : signal_{signal} {
  if (!signal) return;
  row_ = plan.layout.signals[*signal].row;
  slow_ = distance_of(plan, plan.pdos.tpdos[row_]) > longest_silence;
}

std::optional<std::int64_t> AxisSource::take(Time now, const ReceivedValues& received) noexcept {
  if (!signal_) return std::nullopt;
  const std::uint32_t before = std::exchange(frames_, received.marks[row_].received);
  stale_ = is_stale(*signal_, received);
  if (!std::exchange(begun_, true)) {
    newest_ = now;
    return std::nullopt;
  }
  if (before == frames_) return std::nullopt;
  newest_ = now;
  return received.values[*signal_];
}

std::optional<std::int64_t> AxisSource::newest(const ReceivedValues& received) const noexcept {
  if (!signal_ || slow_ || is_stale(*signal_, received)) return std::nullopt;
  if (received.marks[row_].received == 0) return std::nullopt;
  return received.values[*signal_];
}

}  // namespace takt
