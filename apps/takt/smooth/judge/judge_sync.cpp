#include <fmt/format.h>

#include "apps/takt/smooth/judge/judges.hpp"
#include "apps/takt/smooth/judge/numbers.hpp"

namespace takt::smooth {

void judge_sync(const BusRecord& bus, const SyncGrid& sync, Findings& findings) {
  if (sync.period == Time{} || !bus.with_times) return;
  const std::uint64_t periods = sync.ticks.size();
  if (sync.surplus * 5 > periods) {
    findings.push_back(
        {.cause = Cause::two_sync_producers,
         .text =
             fmt::format("SYNC comes {} more than once in its period of {:.3f} ms, first "
                         "at {:.3f} s: a second device or program produces SYNC.",
                         times_text(sync.surplus), ms(sync.period), seconds(sync.first_surplus)),
         .remedy = "Let one device alone produce SYNC: clear bit 30 of 0x1005 in all others, and "
                   "stop the second program.",
         .count = sync.surplus,
         .first = sync.first_surplus});
  } else if (sync.surplus != 0) {
    findings.push_back(
        {.cause = Cause::two_sync_producers,
         .text =
             fmt::format("SYNC comes {} although the period of {:.3f} ms is not over, "
                         "first at {:.3f} s.",
                         times_text(sync.surplus), ms(sync.period), seconds(sync.first_surplus)),
         .remedy = "Look for a second producer of SYNC (bit 30 of 0x1005), and for a master that "
                   "sends a SYNC again to catch up.",
         .count = sync.surplus,
         .first = sync.first_surplus});
  }
  if (sync.missing != 0) {
    findings.push_back(
        {.cause = Cause::sync_missing,
         .text = fmt::format("SYNC is missing in {} of {:.3f} ms, first at {:.3f} s: the "
                             "drives extrapolate, and then jump to the next set-point.",
                             counted(sync.missing, "period"), ms(sync.period),
                             seconds(sync.first_missing)),
         .remedy = "The producer of SYNC missed its time, or its transmit queue was full: give it "
                   "a real-time thread, and see whether `ip -s link` counts dropped frames. If "
                   "the recording itself lost frames, record again.",
         .count = sync.missing,
         .first = sync.first_missing});
  }
  const bool often = sync.unpunctual * 100 > periods && sync.unpunctual > 2;
  if (often && bus.resolution * 10 < sync.period) {
    findings.push_back(
        {.cause = Cause::sync_jitter,
         .text = fmt::format("SYNC is not punctual: {} of {} intervals differ by more than a tenth "
                             "from {:.3f} ms, the worst by {:.3f} ms, the first at {:.3f} s.",
                             sync.unpunctual, periods, ms(sync.period), ms(sync.largest_deviation),
                             seconds(sync.first_unpunctual)),
         .remedy = "Send SYNC from a real-time thread with absolute deadlines (SCHED_FIFO, a "
                   "kernel with PREEMPT_RT), with an adapter on PCI or SPI instead of USB, or let "
                   "a drive produce SYNC.",
         .count = sync.unpunctual,
         .first = sync.first_unpunctual});
  }
}

}  // namespace takt::smooth
