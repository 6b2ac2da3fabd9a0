#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <utility>

#include "apps/takt/smooth/judge/judges.hpp"
#include "apps/takt/smooth/judge/numbers.hpp"

namespace takt::smooth {
namespace {

constexpr std::size_t around = 4;  // cycles before and after; their steps are the usual ones
constexpr std::uint64_t fewest_of_beat = 6;

/// Cycles in motion whose value is not one usual step after the previous one.
struct Strange {
  std::vector<std::size_t> repeats;  // the value is repeated, and then the usual step follows
  std::vector<std::size_t> doubles;  // the value is repeated, and a larger step compensates for it
  std::vector<std::size_t> skips;    // the step is twice the usual one
};

/// Returns the usual step around a cycle, or std::nullopt if the cycles there are not clean.
std::optional<double> usual_step(const AxisCycles& cycles, std::size_t at) {
  if (at <= around || !cycles.clean(at - around, at + around)) return {};
  std::vector<double> steps;
  for (std::size_t i = at - around; i <= at + around; ++i) {
    if (i != at) steps.push_back(static_cast<double>(cycles.step(i)));
  }
  return median(std::move(steps));
}

/// Returns true if the step is so large that rounding cannot explain a repeated value.
bool is_large(const AxisCycles& cycles, double step) {
  return std::abs(step) > 6.0 * static_cast<double>(cycles.quantum) &&
         std::abs(step) > 0.05 * cycles.peak;
}

Strange find_strange(const AxisCycles& cycles) {
  Strange out;
  for (std::size_t i = around + 1; i + around < cycles.cycles.size(); ++i) {
    if (cycles.stall(i) > around) out.doubles.push_back(i);
    const auto usual = usual_step(cycles, i);
    if (!usual || !is_large(cycles, *usual)) continue;
    const double relative = static_cast<double>(cycles.step(i)) / *usual;
    if (cycles.step(i) == 0) {
      const double next = static_cast<double>(cycles.step(i + 1)) / *usual;
      (next > 1.6 && next < 2.4 ? out.doubles : out.repeats).push_back(i);
    } else if (relative > 1.7 && relative < 2.3 && cycles.step(i - 1) != 0 &&
               std::abs(static_cast<double>(cycles.step(i + 1)) / *usual - 1) < 0.3 &&
               std::abs(static_cast<double>(cycles.step(i - 1)) / *usual - 1) < 0.3) {
      out.skips.push_back(i);
    }
  }
  return out;
}

/// Returns the usual distance between the places if most of them have this distance, else 0.
double regular_distance(const std::vector<std::size_t>& places) {
  if (places.size() < fewest_of_beat) return 0;
  std::vector<double> apart;
  for (std::size_t i = 1; i < places.size(); ++i) {
    apart.push_back(static_cast<double>(places[i] - places[i - 1]));
  }
  const double usual = median(apart);
  const auto near = std::ranges::count_if(
      apart, [&](double d) { return std::abs(d - usual) <= std::max(1.5, 0.1 * usual); });
  return static_cast<double>(near) >= 0.7 * static_cast<double>(apart.size()) ? usual : 0;
}

/// Lengths of the runs of equal values in motion.
struct Runs {
  std::size_t usual = 0;  // cycles
  double share = 0;       // share of the cycles in motion that repeat the previous value
  double regular = 0;     // share of the runs that are as long as the usual one
};

Runs measure_runs(const AxisCycles& cycles) {
  Runs out;
  std::vector<std::size_t> lengths;
  std::size_t repeats = 0;
  std::size_t all = 0;
  std::size_t length = 0;  // 0: the beginning of the run is not known
  for (std::size_t i = 1; i < cycles.cycles.size(); ++i) {
    if (!cycles.cycles[i].moving) {
      length = 0;
      continue;
    }
    ++all;
    if (cycles.step(i) == 0) {
      ++repeats;
      if (length != 0) ++length;
    } else {
      if (length != 0) lengths.push_back(length);
      length = 1;
    }
  }
  if (lengths.size() < 8) return out;
  out.usual = median(lengths);
  out.share = static_cast<double>(repeats) / static_cast<double>(all);
  const auto near = std::ranges::count_if(
      lengths, [&](std::size_t each) { return each + 1 >= out.usual && each <= out.usual + 1; });
  out.regular = static_cast<double>(near) / static_cast<double>(lengths.size());
  return out;
}

bool add_slow_values(const AxisView& view, Findings& findings) {
  const AxisCycles& cycles = view.cycles;
  const Runs runs = measure_runs(cycles);
  if (runs.usual < 2 || runs.share < 0.35 || runs.regular < 0.7) return false;
  if (cycles.peak < 6.0 * static_cast<double>(cycles.quantum)) return false;
  const Time period = cycles.period * static_cast<std::int64_t>(runs.usual);
  findings.push_back(
      {.cause = Cause::slow_values,
       .text = fmt::format("The value of the set-point changes only every {} cycles, about every "
                           "{:.3f} ms, while a set-point is sent every {:.3f} ms: the axis moves "
                           "in steps.",
                           runs.usual, ms(period), ms(cycles.period)),
       .remedy = fmt::format("Compute a set-point for each SYNC. If the application is too slow, "
                             "let the master or the drive make the path: a motion of the master, "
                             "profile position (mode 1), or set-points every {:.3f} ms with 60C2 "
                             "for this period.",
                             ms(period))});
  return true;
}

void add_value_beat(const AxisCycles& cycles, std::size_t times, double apart, bool slower,
                    std::size_t first, Findings& findings) {
  const double factor = slower ? apart / (apart - 1) : apart / (apart + 1);
  findings.push_back(
      {.cause = Cause::value_beat,
       .text = fmt::format(
           "{} about every {:.0f} cycles, {} times in motion, first at {:.3f} s: the "
           "application computes set-points every {:.4f} ms, and they are sent "
           "every {:.4f} ms.",
           slower ? "A value is sent twice" : "A value is left out", apart, times,
           seconds(cycles.cycles[first].end), ms(cycles.period) * factor, ms(cycles.period)),
       .remedy = "Let the application compute one set-point for each SYNC or each image that it "
                 "receives, instead of using its own timer.",
       .count = times,
       .first = cycles.cycles[first].end});
}

void add_duplicated(const AxisCycles& cycles, const Strange& strange, Findings& findings) {
  const std::size_t times = strange.doubles.size() + strange.repeats.size();
  if (times == 0) return;
  std::size_t first = cycles.cycles.size();
  if (!strange.doubles.empty()) first = strange.doubles.front();
  if (!strange.repeats.empty()) first = std::min(first, strange.repeats.front());
  findings.push_back(
      {.cause = Cause::duplicated,
       .gravity = times > 2 ? Gravity::error : Gravity::warning,
       .text = fmt::format(
           "In motion, a value is sent again {}, first at {:.3f} s. A longer step "
           "makes up for it {}: the velocity drops to zero and then jumps above its normal value.",
           times_text(times), seconds(cycles.cycles[first].end),
           times_text(strange.doubles.size())),
       .remedy = "The application did not deliver its set-point in time, so the sender repeated "
                 "the old one: begin the computation with the arrival of the image, and give the "
                 "application a real-time priority.",
       .count = times,
       .first = cycles.cycles[first].end});
}

void add_value_skipped(const AxisCycles& cycles, const std::vector<std::size_t>& skips,
                       Findings& findings) {
  if (skips.empty()) return;
  const Time first = cycles.cycles[skips.front()].end;
  findings.push_back(
      {.cause = Cause::value_skipped,
       .gravity = skips.size() > 2 ? Gravity::error : Gravity::warning,
       .text = fmt::format("In motion, a step is twice as long as its neighbours {}, first at "
                           "{:.3f} s: a set-point between them was computed but not sent.",
                           times_text(skips.size()), seconds(first)),
       .remedy =
           "Compare the cycle counters of the sender and of the application: where the application "
           "is one cycle ahead, it has replaced a set-point before the sender sent it.",
       .count = skips.size(),
       .first = first});
}

}  // namespace

void judge_values(const AxisView& view, Findings& findings) {
  const AxisCycles& cycles = view.cycles;
  if (cycles.moving < 3 * around || add_slow_values(view, findings)) return;
  Strange strange = find_strange(cycles);
  const double repeats_apart = regular_distance(strange.repeats);
  if (repeats_apart > 1 && strange.repeats.size() > strange.doubles.size()) {
    add_value_beat(cycles, strange.repeats.size(), repeats_apart, true, strange.repeats.front(),
                   findings);
    strange.repeats.clear();
  }
  const double skips_apart = regular_distance(strange.skips);
  if (skips_apart > 1) {
    add_value_beat(cycles, strange.skips.size(), skips_apart, false, strange.skips.front(),
                   findings);
    strange.skips.clear();
  }
  add_duplicated(cycles, strange, findings);
  add_value_skipped(cycles, strange.skips, findings);
}

}  // namespace takt::smooth
