#include "apps/takt/smooth/judge/axis_cycles.hpp"

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <set>
#include <utility>

#include "apps/takt/smooth/judge/numbers.hpp"
#include "apps/takt/smooth/judge/signals.hpp"

namespace takt::smooth {
namespace {

constexpr std::size_t fewest_set_points = 16;
constexpr double longest_stride = 1000;  // SYNCs from one set-point to the next
constexpr std::size_t reach = 4;  // number of cycles before and after a motion that belong to it
constexpr std::size_t longest_stair = 50;  // cycles with one value within a motion

Time usual_interval(const std::vector<Sample>& samples) {
  std::vector<Time> intervals;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    intervals.push_back(samples[i].when - samples[i - 1].when);
  }
  return median(std::move(intervals));
}

/// Makes the cycles from SYNC to SYNC, or without SYNC from set-point to set-point.
class CycleBuilder {
 public:
  CycleBuilder(const AxisRecord& axis, const SyncGrid& sync) : axis_{axis}, sync_{sync} {}

  AxisCycles build() {
    if (axis_.set_points.size() < fewest_set_points) return {};
    const Time usual = usual_interval(axis_.set_points);
    out_.by_sync = sync_.period > Time{};
    if (out_.by_sync) {
      find_stride(usual);
      add_sync_cycles();
    } else {
      out_.period = usual;
      add_set_point_cycles();
    }
    mark_motion();
    measure_steps();
    return std::move(out_);
  }

 private:
  void find_stride(Time usual) {
    const double syncs = ratio(usual, sync_.period);
    const double whole = std::round(syncs);
    const bool even =
        whole >= 2 && whole <= longest_stride && std::abs(syncs - whole) < 0.03 * whole;
    out_.stride = even ? static_cast<unsigned>(whole) : 1;
    out_.period = sync_.period * out_.stride;
  }

  /// Returns the position of each tick, counted in periods.
  std::vector<std::uint64_t> numbers() const {
    std::vector<std::uint64_t> list;
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < sync_.ticks.size(); ++i) {
      if (i != 0) number += sync_.ticks[i].periods;
      list.push_back(number);
    }
    return list;
  }

  /// Returns the offset, within `stride` SYNCs, of the SYNC that ends a cycle. It is the SYNC
  /// before which most set-points come.
  std::uint64_t best_offset(const std::vector<std::uint64_t>& numbers) const {
    if (out_.stride == 1) return 0;
    std::vector<std::uint64_t> hits(out_.stride);
    std::size_t tick = 0;
    for (const Sample& sample : axis_.set_points) {
      while (tick < sync_.ticks.size() && sync_.ticks[tick].when < sample.when) ++tick;
      if (tick == sync_.ticks.size()) break;
      ++hits[numbers[tick] % out_.stride];
    }
    return static_cast<std::uint64_t>(std::ranges::max_element(hits) - hits.begin());
  }

  void add_sync_cycles() {
    const auto places = numbers();
    const std::uint64_t offset = best_offset(places);
    std::size_t next = 0;
    std::optional<std::size_t> begin;
    std::int64_t value = axis_.set_points.front().value;
    for (std::size_t i = 0; i < sync_.ticks.size(); ++i) {
      if (places[i] % out_.stride != offset) continue;
      Cycle cycle{.end = sync_.ticks[i].when, .value = value};
      for (; next < axis_.set_points.size() && axis_.set_points[next].when < cycle.end; ++next) {
        const Sample& sample = axis_.set_points[next];
        if (!begin || sample.when < sync_.ticks[*begin].when) continue;
        if (cycle.count != 0 && sample.value != cycle.value) cycle.varied = true;
        if (cycle.count++ == 0) cycle.first_arrival = sample.when;
        cycle.arrival = sample.when;
        cycle.value = sample.value;
      }
      if (begin) {
        cycle.begin = sync_.ticks[*begin].when;
        cycle.whole = places[i] - places[*begin] == out_.stride;
        out_.cycles.push_back(cycle);
      }
      value = cycle.value;
      begin = i;
    }
  }

  void add_set_point_cycles() {
    for (std::size_t i = 1; i < axis_.set_points.size(); ++i) {
      const Sample& now = axis_.set_points[i];
      out_.cycles.push_back({.begin = axis_.set_points[i - 1].when,
                             .end = now.when,
                             .count = 1,
                             .first_arrival = now.when,
                             .arrival = now.when,
                             .value = now.value});
    }
  }

  void mark_motion() {
    Held status{axis_.statuswords};
    Held mode{axis_.modes};
    Held asked{axis_.asked_modes};
    for (Cycle& cycle : out_.cycles) {
      cycle.active = is_enabled(status.at(cycle.begin)) && is_cyclic(mode, asked, cycle.begin);
    }
    std::optional<std::size_t> before;  // cycle of the previous step
    for (std::size_t i = 1; i < out_.cycles.size(); ++i) {
      if (out_.step(i) == 0 && !out_.cycles[i].varied) continue;
      const bool one_motion = before && i - *before <= longest_stair;
      mark(one_motion ? *before : i - std::min(i, reach), i + reach);
      before = i;
    }
    count_clean_runs();
    out_.moving = static_cast<std::size_t>(std::ranges::count(out_.cycles, true, &Cycle::moving));
  }

  void count_clean_runs() {
    std::uint32_t run = 0;
    for (const Cycle& cycle : out_.cycles) {
      run = cycle.moving && cycle.whole && cycle.count == 1 ? run + 1 : 0;
      out_.clean_run.push_back(run);
    }
  }

  void mark(std::size_t first, std::size_t last) {
    for (std::size_t i = first; i <= last && i < out_.cycles.size(); ++i) {
      out_.cycles[i].moving = out_.cycles[i].active;
    }
  }

  static bool is_enabled(std::optional<std::int64_t> statusword) {
    return !statusword || is_operation_enabled(*statusword);
  }

  bool is_cyclic(Held& mode, Held& asked, Time when) const {
    const auto shown = mode.at(when);
    const auto wanted = asked.at(when);
    if (shown) return is_cyclic_mode(*shown, axis_.by_velocity);
    if (wanted) return is_cyclic_mode(*wanted, axis_.by_velocity);
    return !axis_.settings.mode || is_cyclic_mode(*axis_.settings.mode, axis_.by_velocity);
  }

  void measure_steps() {
    std::vector<std::int64_t> steps;
    std::int64_t divisor = 0;
    std::set<std::int64_t> kinds;
    for (std::size_t i = 1; i < out_.cycles.size(); ++i) {
      if (!out_.cycles[i].moving || !out_.cycles[i].whole) continue;
      const std::int64_t size = std::abs(out_.step(i));
      if (size == 0) continue;
      steps.push_back(size);
      divisor = std::gcd(divisor, size);
      if (kinds.size() < 8) kinds.insert(size);
    }
    if (kinds.size() >= 4 && divisor != 0) out_.quantum = divisor;
    out_.peak = static_cast<double>(quantile(std::move(steps), 0.9));
  }

  const AxisRecord& axis_;
  const SyncGrid& sync_;
  AxisCycles out_;
};

}  // namespace

std::int64_t difference(std::int64_t a, std::int64_t b) noexcept {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

std::int64_t AxisCycles::step(std::size_t at) const noexcept {
  return difference(cycles[at].value, cycles[at - 1].value);
}

bool AxisCycles::clean(std::size_t first, std::size_t last) const noexcept {
  return first != 0 && last < cycles.size() && clean_run[last] > last - first;
}

std::size_t AxisCycles::stall(std::size_t at) const noexcept {
  if (at < 3 || step(at) != 0) return 0;
  const auto before = static_cast<double>(step(at - 1));
  if (std::abs(before) <= 6.0 * static_cast<double>(quantum)) return 0;
  std::size_t end = at;
  while (end < cycles.size() && end - at <= longest_stair && step(end) == 0) ++end;
  if (end >= cycles.size() || !clean(at - 1, end)) return 0;
  const auto missing = static_cast<double>(end - at + 1);
  const double caught_up = static_cast<double>(step(end)) / before;
  return caught_up > 1.5 && caught_up > 0.5 * missing ? end - at : 0;
}

double AxisCycles::velocity(double step) const noexcept { return step / seconds(period); }

AxisCycles axis_cycles(const AxisRecord& axis, const SyncGrid& sync) {
  return CycleBuilder{axis, sync}.build();
}

}  // namespace takt::smooth
