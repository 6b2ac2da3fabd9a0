#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

#include "apps/takt/smooth/judge/judges.hpp"
#include "apps/takt/smooth/judge/numbers.hpp"
#include "apps/takt/smooth/judge/position_following.hpp"
#include "apps/takt/smooth/judge/signals.hpp"

namespace takt::smooth {
namespace {

/// Returns the velocity of the set-points before a time: the mean step of the last cycles.
double step_before(const AxisCycles& cycles, Time when) {
  const auto after = std::ranges::upper_bound(cycles.cycles, when, {}, &Cycle::end);
  const auto at = static_cast<std::size_t>(after - cycles.cycles.begin());
  if (at < 8 || at > cycles.cycles.size()) return 0;
  const auto change = difference(cycles.cycles[at - 1].value, cycles.cycles[at - 7].value);
  return static_cast<double>(change) / 6;
}

bool in_motion(const AxisCycles& cycles, Time when) {
  return cycles.peak > 0 && std::abs(step_before(cycles, when)) > 0.05 * cycles.peak;
}

bool wants_operation(std::int64_t controlword) { return (controlword & 0x8F) == 0x0F; }

void judge_state(const AxisView& view, Findings& findings) {
  const auto& words = view.axis.statuswords;
  Held control{view.axis.controlwords};
  std::uint64_t count = 0;
  Time first{};
  std::int64_t word = 0;
  bool asked = false;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const bool leaves =
        is_operation_enabled(words[i - 1].value) && !is_operation_enabled(words[i].value);
    if (!leaves || !in_motion(view.cycles, words[i].when)) continue;
    if (count++ != 0) continue;
    first = words[i].when;
    word = words[i].value;
    const auto controlword = control.at(first);
    asked = controlword && !wants_operation(*controlword);
  }
  if (count == 0) return;
  const bool fault = (word & 0x48) == 0x08;
  findings.push_back(
      {.cause = Cause::left_operation,
       .gravity = asked ? Gravity::warning : Gravity::error,
       .text =
           fmt::format("The drive leaves Operation enabled in motion, {}, first at {:.3f} "
                       "s (statusword 0x{:04X}{}).",
                       times_text(count), seconds(first), word & 0xFFFF, fault ? ", a fault" : ""),
       .remedy = asked ? "The controlword asks for it: stop the motion before the axis is disabled."
                 : fault
                     ? "Read 0x603F and the EMCY of the drive: the fault is the cause."
                     : "The controlword does not ask for it: look for a limit switch, a missing "
                       "enable input (STO) or a low supply voltage.",
       .count = count,
       .first = first});
}

void judge_mode(const AxisView& view, Findings& findings) {
  const auto& modes = view.axis.modes.empty() ? view.axis.asked_modes : view.axis.modes;
  Held status{view.axis.statuswords};
  std::uint64_t count = 0;
  Time first{};
  std::int64_t mode = 0;
  for (std::size_t i = 1; i < modes.size(); ++i) {
    const bool leaves = is_cyclic_mode(modes[i - 1].value, view.axis.by_velocity) &&
                        !is_cyclic_mode(modes[i].value, view.axis.by_velocity);
    if (!leaves || !in_motion(view.cycles, modes[i].when)) continue;
    const auto word = status.at(modes[i].when);
    if (word && !is_operation_enabled(*word)) continue;
    if (count++ != 0) continue;
    first = modes[i].when;
    mode = modes[i].value;
  }
  if (count == 0) return;
  findings.push_back(
      {.cause = Cause::mode_changed,
       .text = fmt::format("The drive changes its mode of operation in motion, {}, first at "
                           "{:.3f} s to mode {}: it no longer follows the set-points.",
                           times_text(count), seconds(first), mode),
       .remedy = "Change 0x6060 only at standstill. If the sender does not change it, look for a "
                 "second program that writes 0x6060.",
       .count = count,
       .first = first});
}

void judge_delay(const AxisView& view, const Following& following, Findings& findings) {
  if (following.cycles < 50) return;
  const Time usual = 3 * view.cycles.period + std::chrono::milliseconds{4};
  if (!view.axis.settings.feed_forward && following.fit > 0.9 && following.delay > usual) {
    findings.push_back(
        {.cause = Cause::feed_forward,
         .gravity = Gravity::warning,
         .text = fmt::format("The following error is in proportion to the velocity: the axis is "
                             "{:.1f} ms behind its set-points, {:.0f} increments at full velocity.",
                             ms(following.delay), following.error_at_peak),
         .remedy = "Switch on the velocity feed-forward of the drive, or map the velocity offset "
                   "60B1 and send the velocity of the path in it. Axes with different delays leave "
                   "their common path."});
  }
}

void judge_ripple(const Following& following, Findings& findings) {
  // The tolerance for 606C is larger because 606C is noisy: many drives compute it from few
  // increments of the encoder.
  const double allowed = following.by_velocity ? 0.12 : 0.06;
  if (following.ripple < allowed || following.ripple_units < 2) return;
  const std::string frequency =
      following.frequency == 0 ? "" : fmt::format(", mostly at {:.1f} Hz", following.frequency);
  findings.push_back(
      {.cause = Cause::actual_ripple,
       .text = fmt::format(
           "The set-points are smooth, but the velocity of the drive ({}) ripples by "
           "{:.1f} %{}.",
           following.by_velocity ? "606C" : "steps of 6064", 100 * following.ripple, frequency),
       .remedy = "The cause is in the drive or in the mechanics: lower the gains of the position "
                 "and velocity controllers, check the encoder and its coupling, and look for a "
                 "resonance or cogging at this frequency."});
}

}  // namespace

void judge_drive(const AxisView& view, Findings& findings) {
  if (view.cycles.moving == 0) return;
  judge_state(view, findings);
  judge_mode(view, findings);
  if (view.axis.by_velocity) return;
  const Following following = following_of(view.axis, view.cycles);
  judge_delay(view, following, findings);
  judge_ripple(following, findings);
}

}  // namespace takt::smooth
