#include "master/rt/beat/beat.hpp"

#include <chrono>

namespace takt {

Beat::Beat(const BusPlan& plan, EventQueue& events, BusStatus& status, TimingHistograms& timing)
    : plan_{plan.cycle},
      status_{status},
      timing_{timing},
      clock_{plan.cycle.period},
      counter_{plan.cycle.sync_overflow},
      hold_{plan},
      gate_{plan.cycle.period},
      follower_{plan.cycle, events},
      missed_{events, status} {}

void Beat::start(Time now) noexcept {
  previous_sync_ = now;
  clock_.start(now + clock_.period());
}

/// Records a beat that was late by whole periods, once the number of skipped periods is known.
void Beat::record_skipped(std::uint64_t periods) noexcept {
  timing_.sync_lateness.record(static_cast<std::int64_t>(periods) * clock_.period());
}

/// Begins a cycle with the SYNC of another device. Returns the number of periods without SYNC.
std::uint64_t Beat::begin_by_sync(bool was_locked) noexcept {
  sync_at_ = follower_.take();
  const Time off = std::chrono::abs(sync_at_ - clock_.deadline());
  const std::uint64_t missed = clock_.follow(follower_.beat(), follower_.period());
  if (was_locked && missed == 0) timing_.sync_lateness.record(off);
  if (was_locked && off > clock_.period() / 10) ++status_.cycles_late;
  return missed;
}

/// Begins a cycle although no SYNC of another device has come. Returns the number of skipped
/// periods.
std::uint64_t Beat::begin_without_sync(Time now, std::span<const NodeStatus> nodes,
                                       bool was_locked) noexcept {
  follower_.on_silence(now, nodes);
  const std::uint64_t missed = clock_.skip_missed(now - follower_.sync_wait());
  if (was_locked) missed_.unheard();
  // After a stall the deadline may lie in the future, and a SYNC may come before it.
  sync_at_ = std::min(clock_.deadline(), now);
  return missed;
}

SyncState Beat::sync_state() const noexcept {
  if (!follower_.used()) return plan_.sync ? SyncState::made : SyncState::none;
  if (follower_.lost()) return SyncState::lost;
  return follower_.waiting() ? SyncState::awaited : SyncState::locked;
}

}  // namespace takt
