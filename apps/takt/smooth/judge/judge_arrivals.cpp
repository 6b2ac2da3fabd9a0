#include <cmath>
#include <fmt/format.h>
#include <initializer_list>
#include <numbers>

#include "apps/takt/smooth/judge/judges.hpp"
#include "apps/takt/smooth/judge/numbers.hpp"
#include "apps/takt/smooth/judge/wire_load.hpp"

namespace takt::smooth {
namespace {

/// The number of times that something happened, and the time at which it happened first.
struct Tally {
  std::uint64_t count = 0;
  Time first{};

  void add(Time when) {
    if (count++ == 0) first = when;
  }
};

/// Deviations from the rule that each cycle in motion gets one set-point.
struct Arrivals {
  Tally late;                            // no set-point, and two in the next cycle
  Tally early;                           // two set-points, and none in the next cycle
  Tally skipped;                         // no set-point
  Tally overwritten;                     // two set-points
  std::uint32_t longest_gap = 0;         // cycles without set-point
  std::vector<std::size_t> late_cycles;  // cycles in which the late set-points came
  std::vector<Time> lateness;
  std::vector<Time> earliness;
};

Arrivals count_arrivals(const std::vector<Cycle>& cycles) {
  Arrivals out;
  const auto counts = [&](std::size_t i) { return cycles[i].moving && cycles[i].whole; };
  for (std::size_t i = 0; i < cycles.size();) {
    if (!counts(i) || cycles[i].count == 1) {
      ++i;
      continue;
    }
    if (cycles[i].count == 0) {
      std::size_t end = i;
      while (end < cycles.size() && cycles[end].count == 0 && counts(end)) ++end;
      const auto gap = static_cast<std::uint32_t>(end - i);
      out.longest_gap = std::max(out.longest_gap, gap);
      const bool made_up = end < cycles.size() && counts(end) && cycles[end].count >= 2;
      if (made_up) {
        out.late.add(cycles[i].end);
        out.late_cycles.push_back(end);
        out.lateness.push_back(cycles[end].first_arrival - cycles[i].end);
      } else {
        for (std::size_t k = i; k < end; ++k) out.skipped.add(cycles[k].end);
      }
      i = made_up ? end + 1 : end;
      continue;
    }
    const bool too_early = i + 1 < cycles.size() && counts(i + 1) && cycles[i + 1].count == 0;
    (too_early ? out.early : out.overwritten).add(cycles[i].arrival);
    if (too_early) out.earliness.push_back(cycles[i].end - cycles[i].arrival);
    i += too_early ? 2 : 1;
  }
  return out;
}

/// The relation between the times of the set-points and SYNC.
struct Rhythm {
  Time period{};       // period of the set-points
  double slips = 0;    // periods by which set-points and SYNC diverge in the recording
  double focus = 1;    // 1: always at one place between two SYNCs; 0: anywhere
  double steady = 0;   // share of intervals that are near the usual one
  Time usual_phase{};  // usual time after SYNC
};

Rhythm rhythm_of(const AxisView& view) {
  const auto& cycles = view.cycles.cycles;
  Rhythm out;
  std::vector<Time> intervals;
  std::vector<Time> phases;
  double x = 0;
  double y = 0;
  std::size_t cycle = 0;
  std::optional<Time> before;
  for (const Sample& sample : view.axis.set_points) {
    while (cycle < cycles.size() && cycles[cycle].end < sample.when) ++cycle;
    if (cycle == cycles.size()) break;
    if (!cycles[cycle].active || !cycles[cycle].whole || sample.when < cycles[cycle].begin) {
      before.reset();
      continue;
    }
    if (before) intervals.push_back(sample.when - *before);
    before = sample.when;
    const Time phase = sample.when - cycles[cycle].begin;
    phases.push_back(phase);
    const double angle =
        2 * std::numbers::pi * ratio(phase, cycles[cycle].end - cycles[cycle].begin);
    x += std::cos(angle);
    y += std::sin(angle);
  }
  if (intervals.empty()) return out;
  const Time usual = median(intervals);
  out.focus = std::hypot(x, y) / static_cast<double>(phases.size());
  out.usual_phase = median(phases);
  double periods = 0;
  Time sum{};
  std::size_t near = 0;
  for (const Time interval : intervals) {
    if (distance(interval, usual) < usual / 4) ++near;
    periods += std::round(ratio(interval, usual));
    sum += interval;
  }
  out.steady = static_cast<double>(near) / static_cast<double>(intervals.size());
  out.period = scaled(sum, 1 / std::max(1.0, periods));
  out.slips = std::abs(periods - ratio(sum, view.cycles.period));
  return out;
}

bool is_beat(const Rhythm& rhythm) {
  return rhythm.steady > 0.75 && rhythm.slips > 1.5 && rhythm.focus < 0.5;
}

std::string first_text(const Tally& tally) {
  return fmt::format("the first at {:.3f} s", seconds(tally.first));
}

Time earliest(std::initializer_list<Tally> tallies) {
  Time first = Time::max();
  for (const Tally& tally : tallies) {
    if (tally.count != 0) first = std::min(first, tally.first);
  }
  return first;
}

Finding beat_finding(const AxisView& view, const Arrivals& seen, const Rhythm& rhythm) {
  const double apart = std::abs(1 / ms(rhythm.period) - 1 / ms(view.cycles.period));
  return {.cause = Cause::clock_beat,
          .text = fmt::format(
              "Set-points come every {:.4f} ms and SYNC every {:.4f} ms: the sender does not use "
              "the clock of SYNC, so its set-points drift through a whole period of SYNC once in "
              "{:.2f} s. In motion, {} got no set-point and {} got two.",
              ms(rhythm.period), ms(view.cycles.period / view.cycles.stride), 1e-3 / apart,
              counted(seen.skipped.count + seen.late.count + seen.early.count, "cycle"),
              seen.overwritten.count + seen.late.count + seen.early.count),
          .remedy =
              "Let the sender compute and send one set-point for each SYNC that it receives, "
              "instead of using its own timer.",
          .count = seen.skipped.count + seen.overwritten.count + seen.late.count + seen.early.count,
          .first = earliest({seen.late, seen.early, seen.skipped, seen.overwritten})};
}

/// Returns the share of the late set-points for which the bus was busy from their usual time until
/// their arrival.
double share_behind_others(const AxisView& view, const Arrivals& seen, const Rhythm& rhythm) {
  std::size_t busy = 0;
  for (const std::size_t at : seen.late_cycles) {
    const Cycle& cycle = view.cycles.cycles[at];
    const Time from = view.cycles.cycles[at - 1].begin + rhythm.usual_phase;
    if (wire_load(view.bus, from, cycle.first_arrival) > 0.85) ++busy;
  }
  return static_cast<double>(busy) / static_cast<double>(seen.late_cycles.size());
}

Gravity gravity_of(std::uint64_t count) { return count > 2 ? Gravity::error : Gravity::warning; }

void add_late(const AxisView& view, const Arrivals& seen, const Rhythm& rhythm,
              Findings& findings) {
  const Tally& late = seen.late;
  const Time worst = *std::ranges::max_element(seen.lateness);
  if (view.bus.bitrate != 0 && share_behind_others(view, seen, rhythm) > 0.6) {
    findings.push_back(
        {.cause = Cause::bus_load,
         .gravity = gravity_of(late.count),
         .text = fmt::format("Other frames occupy the bus when the set-point is due: {} came after "
                             "the next SYNC instead of before it, by up to {:.3f} ms, {}.",
                             counted(late.count, "set-point"), ms(worst), first_text(late)),
         .remedy = "Give the RPDO a lower COB-ID, send it earlier after SYNC, send less "
                   "(inhibit times, fewer PDOs), or raise the bit rate. `takt budget` computes "
                   "what fits.",
         .count = late.count,
         .first = late.first});
    return;
  }
  findings.push_back(
      {.cause = Cause::late,
       .gravity = gravity_of(late.count),
       .text = fmt::format("{} came after the next SYNC instead of before it, by up to {:.3f} ms, "
                           "{}. The drive gets no set-point in one cycle and two in the next.{}",
                           counted(late.count, "set-point"), ms(worst), first_text(late),
                           seen.early.count == 0 ? ""
                                                 : fmt::format(" {} more came one SYNC too early.",
                                                               seen.early.count)),
       .remedy = fmt::format("Set-points usually come {:.3f} ms after SYNC, in a period of {:.3f} "
                             "ms: send them earlier, and from a real-time thread.",
                             ms(rhythm.usual_phase), ms(view.cycles.period)),
       .count = late.count,
       .first = late.first});
}

void add_early(const AxisView& view, const Arrivals& seen, const Rhythm& rhythm,
               Findings& findings) {
  const Tally& early = seen.early;
  findings.push_back(
      {.cause = Cause::early,
       .gravity = gravity_of(early.count),
       .text =
           fmt::format("{} came before the previous SYNC instead of after it, by up to {:.3f} ms, "
                       "{}. The drive gets two set-points in one cycle and none in the next.",
                       counted(early.count, "set-point"),
                       ms(*std::ranges::max_element(seen.earliness)), first_text(early)),
       .remedy = fmt::format("Set-points usually come {:.3f} ms after SYNC, in a period of {:.3f} "
                             "ms: send them when SYNC has come, not by a timer.",
                             ms(rhythm.usual_phase), ms(view.cycles.period)),
       .count = early.count,
       .first = early.first});
}

}  // namespace

void judge_arrivals(const AxisView& view, Findings& findings) {
  if (!view.cycles.by_sync || view.cycles.moving == 0) return;
  const Arrivals seen = count_arrivals(view.cycles.cycles);
  if (seen.late.count + seen.early.count + seen.skipped.count + seen.overwritten.count == 0) return;
  const Rhythm rhythm = rhythm_of(view);
  if (is_beat(rhythm)) {
    findings.push_back(beat_finding(view, seen, rhythm));
    return;
  }
  if (seen.late.count != 0 && seen.late.count >= seen.early.count) {
    add_late(view, seen, rhythm, findings);
  } else if (seen.early.count != 0) {
    add_early(view, seen, rhythm, findings);
  }
  if (seen.skipped.count != 0) {
    findings.push_back(
        {.cause = Cause::skipped,
         .gravity = gravity_of(seen.skipped.count),
         .text = fmt::format("{} in motion got no set-point, at most {} in a row, {}.",
                             counted(seen.skipped.count, "cycle"), seen.longest_gap,
                             first_text(seen.skipped)),
         .remedy = "The sender missed its cycle or could not send: give it a real-time thread, and "
                   "see whether `ip -s link` counts dropped frames (a transmit queue that is too "
                   "short).",
         .count = seen.skipped.count,
         .first = seen.skipped.first});
  }
  if (seen.overwritten.count != 0) {
    findings.push_back({.cause = Cause::overwritten,
                        .gravity = gravity_of(seen.overwritten.count),
                        .text = fmt::format(
                            "{} in motion got two set-points, {}: the second one replaces "
                            "the first one before the drive has used it.",
                            counted(seen.overwritten.count, "cycle"), first_text(seen.overwritten)),
                        .remedy = "Send one set-point for each SYNC. After a delay, the sender "
                                  "should leave out the set-points that are too late instead of "
                                  "sending all of them. Look for a second sender, too.",
                        .count = seen.overwritten.count,
                        .first = seen.overwritten.first});
  }
}

}  // namespace takt::smooth
