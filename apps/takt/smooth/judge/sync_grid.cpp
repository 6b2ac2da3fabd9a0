#include "apps/takt/smooth/judge/sync_grid.hpp"

#include <cmath>
#include <utility>

#include "apps/takt/smooth/judge/numbers.hpp"

namespace takt::smooth {
namespace {

constexpr std::size_t fewest_syncs = 16;
/// A longer silence, in periods, is a pause, for example between two runs of a master.
constexpr std::uint32_t longest_gap = 50;
/// Share of the period by which a SYNC may be early or late and still belongs to its period.
constexpr double tolerance = 0.35;

std::vector<Time> intervals_of(std::span<const Time> times, std::size_t apart) {
  std::vector<Time> intervals;
  for (std::size_t i = apart; i < times.size(); ++i) {
    intervals.push_back(times[i] - times[i - apart]);
  }
  return intervals;
}

/// Returns the share of values that differ from their median by less than `part` of it.
double steady_share(const std::vector<Time>& values, double part) {
  const Time usual = median(values);
  const auto near = std::ranges::count_if(
      values, [&](Time value) { return distance(value, usual) < scaled(usual, part); });
  return static_cast<double>(near) / static_cast<double>(values.size());
}

/// Returns the usual period of SYNC. If two producers send with the same period, the intervals
/// alternate, but the time over two intervals is steady.
Time usual_period(std::span<const Time> syncs, std::optional<Time> planned) {
  const auto single = intervals_of(syncs, 1);
  const Time usual = median(single);
  const auto twofold = intervals_of(syncs, 2);
  const Time pair = median(twofold);
  if (planned && distance(pair, *planned) < scaled(*planned, 0.05) && usual < *planned * 3 / 4) {
    return pair;
  }
  if (steady_share(single, 0.15) < 0.2 && steady_share(twofold, 0.1) > 0.9) return pair;
  // The intervals of two producers alternate between two lengths.
  const Time low = quantile(single, 0.2);
  const Time high = quantile(single, 0.8);
  const bool alternate = high > low * 3 / 2 && distance(low + high, pair) < scaled(pair, 0.06);
  return alternate && steady_share(twofold, 0.06) > 0.9 ? pair : usual;
}

/// Returns the exact period: the median is coarse if the time stamps are coarse.
Time mean_period(const std::vector<Tick>& ticks, Time usual) {
  std::int64_t periods = 0;
  for (std::size_t i = 1; i < ticks.size(); ++i) periods += ticks[i].periods;
  return periods == 0 ? usual : (ticks.back().when - ticks.front().when) / periods;
}

class GridBuilder {
 public:
  explicit GridBuilder(Time period) { grid_.period = period; }

  void build(std::span<const Time> syncs) {
    grid_.ticks.push_back({syncs[0]});
    place_ = syncs[0];
    for (std::size_t i = 1; i < syncs.size(); ++i) {
      const std::optional<Time> next =
          i + 1 < syncs.size() ? std::optional{syncs[i + 1]} : std::nullopt;
      take(syncs[i], next);
    }
  }

  SyncGrid finish() {
    grid_.period = mean_period(grid_.ticks, grid_.period);
    judge_jitter();
    return std::move(grid_);
  }

 private:
  /// Returns how far a SYNC is from its place in an even grid, or from one period after the
  /// previous SYNC. The smaller of the two differences counts, because some producers keep a grid
  /// and others only an interval.
  Time off(Time when) const {
    return std::min(distance(when, place_ + grid_.period),
                    distance(when, grid_.ticks.back().when + grid_.period));
  }

  void take(Time when, std::optional<Time> next) {
    const Time allowed = scaled(grid_.period, tolerance);
    const bool too_early = when < place_ + grid_.period && off(when) > allowed;
    Tick& newest = grid_.ticks.back();
    if (too_early && newest.periods > 1 && newest.periods <= longest_gap) {
      // The previous SYNC was late: one SYNC less is missing before it.
      --newest.periods;
      --grid_.missing;
      grid_.ticks.push_back({when});
      return;
    }
    if (too_early || (next && off(*next) < off(when))) {
      if (grid_.surplus++ == 0) grid_.first_surplus = when;
      return;
    }
    const double gone = std::min(1e9, ratio(when - place_, grid_.period));
    const auto periods = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(std::lround(gone)));
    if (periods > 1 && periods <= longest_gap) {
      if (grid_.missing == 0) grid_.first_missing = place_ + grid_.period;
      grid_.missing += periods - 1;
    }
    grid_.ticks.push_back({when, periods});
    const Time expected = place_ + grid_.period * periods;
    place_ = periods > longest_gap ? when : expected + (when - expected) / 5;
  }

  void judge_jitter() {
    std::vector<Time> deviations;
    for (std::size_t i = 1; i < grid_.ticks.size(); ++i) {
      if (grid_.ticks[i].periods != 1) continue;
      const Time off = distance(grid_.ticks[i].when - grid_.ticks[i - 1].when, grid_.period);
      deviations.push_back(off);
      grid_.largest_deviation = std::max(grid_.largest_deviation, off);
      if (off <= grid_.period / 10) continue;
      if (grid_.unpunctual++ == 0) grid_.first_unpunctual = grid_.ticks[i].when;
    }
    grid_.jitter = quantile(deviations, 0.95);
  }

  SyncGrid grid_;
  Time place_{};  // time of the newest SYNC in an even grid
};

}  // namespace

SyncGrid sync_grid(std::span<const Time> syncs, std::optional<Time> planned) {
  if (syncs.size() < fewest_syncs) return {};
  const Time usual = usual_period(syncs, planned);
  if (usual <= Time{}) return {};
  GridBuilder builder{usual};
  builder.build(syncs);
  return builder.finish();
}

}  // namespace takt::smooth
