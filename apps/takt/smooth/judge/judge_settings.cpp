#include <cmath>
#include <fmt/format.h>

#include "apps/takt/smooth/judge/judges.hpp"
#include "apps/takt/smooth/judge/numbers.hpp"

namespace takt::smooth {
namespace {

/// Returns 0x60C2 as its two values, for a remedy.
std::string interpolation_text(Time period) {
  const auto us = std::chrono::round<std::chrono::microseconds>(period).count();
  if (us % 1000 == 0 && us / 1000 <= 255)
    return fmt::format("60C2:01 = {}, 60C2:02 = -3", us / 1000);
  if (us % 10 == 0 && us / 10 <= 255) return fmt::format("60C2:01 = {}, 60C2:02 = -5", us / 10);
  return fmt::format("60C2:01 x 10^60C2:02 = {:.3f} ms", ms(period));
}

void judge_interpolation(const AxisView& view, Findings& findings) {
  const AxisSettings& settings = view.axis.settings;
  const Time period = view.cycles.period;
  if (view.axis.by_velocity || !view.cycles.by_sync) return;
  if (settings.interpolation) {
    if (distance(*settings.interpolation, period) < period / 20) return;
    findings.push_back({.cause = Cause::interpolation_period,
                        .text = fmt::format(
                            "The drive interpolates over {:.3f} ms (60C2), but its set-points come "
                            "every {:.3f} ms.{}",
                            ms(*settings.interpolation), ms(period),
                            *settings.interpolation < period
                                ? " It reaches each set-point too early and waits there."
                                : " It has not reached a set-point when the next one comes."),
                        .remedy = fmt::format("Write {} while the drive is PRE-OPERATIONAL.",
                                              interpolation_text(period))});
    return;
  }
  constexpr Time usual = std::chrono::milliseconds{1};
  if (!settings.boot_seen || distance(period, usual) < usual / 20) return;
  findings.push_back(
      {.cause = Cause::interpolation_unset,
       .gravity = Gravity::warning,
       .text =
           fmt::format("{} The drive interpolates over the period that is in 60C2, by default "
                       "often 1 ms, while its set-points come every {:.3f} ms.",
                       settings.interpolation_refused ? "The drive has refused the write to 60C2."
                                                      : "The boot does not write 60C2.",
                       ms(period)),
       .remedy = settings.interpolation_refused
                     ? std::string{"Look in the manual for the periods that the drive accepts in "
                                   "60C2, and use one of them as the period of SYNC."}
                     : fmt::format("Write {} while the drive is PRE-OPERATIONAL.",
                                   interpolation_text(period))});
}

}  // namespace

void judge_settings(const AxisView& view, Findings& findings) {
  if (view.cycles.moving == 0) return;
  if (!view.cycles.by_sync) {
    findings.push_back(
        {.cause = Cause::no_sync,
         .text = fmt::format("There is no SYNC: set-points come by event, about every {:.3f} ms, "
                             "and the clocks of the drive and of the sender are not synchronised.",
                             ms(view.cycles.period)),
         .remedy = "Produce SYNC with the period of the set-points, give the RPDO transmission "
                   "type 1, and write that period to 60C2."});
    return;
  }
  if (view.axis.settings.transmission.value_or(1) > 240) {
    findings.push_back(
        {.cause = Cause::not_synchronous,
         .text =
             fmt::format("RPDO {} has transmission type {}: the drive takes a set-point when it "
                         "arrives, not at SYNC, so each jitter of its arrival moves the axis.",
                         to_string(view.axis.set_point_id), *view.axis.settings.transmission),
         .remedy = "Write transmission type 1 to sub-index 2 of this RPDO (0x1400 to 0x15FF)."});
  }
  judge_interpolation(view, findings);
}

}  // namespace takt::smooth
