#pragma once
// Member functions of BusLoop for the beginning of a cycle, by the master's own SYNC or by the SYNC
// that it follows.
#include <algorithm>
#include <chrono>

#include "master/rt/bus_loop.hpp"
#include "master/wire/sync.hpp"

namespace takt {

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::wait_for_beat() noexcept {
  if (follower_.used()) return wait_for_sync();
  port_.sleep_precisely_until(clock_.deadline());
  Time now = port_.now();
  for (unsigned stalls = 0; stalls < patience_with_stalls; ++stalls) {
    const std::uint64_t missed = clock_.skip_missed(now);
    if (missed == 0) break;
    record_skipped(missed);
    note_missed(missed, now);
    port_.sleep_precisely_until(clock_.deadline());
    now = port_.now();
  }
  sync_sent_ = now;
  const Time late = sync_sent_ - clock_.deadline();
  exchange_.timing.sync_lateness.record(late);
  if (late > clock_.period() / 10) ++status_.cycles_late;
  look_at_wire();
}

/// Records the beat that was due as whole periods late, once the skipped periods are known.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::record_skipped(std::uint64_t missed) noexcept {
  exchange_.timing.sync_lateness.record(static_cast<std::int64_t>(missed) * clock_.period());
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::note_missed(std::uint64_t missed, Time now) noexcept {
  status_.cycles_missed += missed;
  tell(EventKind::cycles_missed, now, static_cast<std::int64_t>(missed));
}

/// Returns true for a SYNC of another device that begins the next cycle. The frames behind it stay
/// for that cycle.
template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::begins_cycle(const StampedFrame& stamped) noexcept {
  if (!follower_.is_sync(stamped.frame)) return false;
  follower_.on_sync(stamped);
  return follower_.arrived();
}

/// Waits until SYNC arrives, or until shortly after its expected time.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::await_sync() noexcept {
  const Time until = follower_.end_of_wait(clock_.deadline());
  bool more = follower_.arrived() || port_.wait_frame(until);
  while (more) {
    drain();
    if (!follower_.arrived()) {
      more = port_.now() < until && port_.wait_frame(until);
    } else if (port_.now() - follower_.arrival() <= clock_.period() / 2) {
      return;
    } else {
      follower_.take();  // The SYNC is too old to begin a cycle; a newer one may be behind it.
    }
  }
}

/// A cycle begins with the arrival of SYNC. If no SYNC comes, the cycle begins by the master's own
/// clock, so that services continue and the loss is detected.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::wait_for_sync() noexcept {
  const bool was_locked = follower_.locked();
  await_sync();
  followed_ = follower_.arrived();
  std::uint64_t missed = 0;
  if (followed_) {
    sync_sent_ = follower_.take();
    const Time off = std::chrono::abs(sync_sent_ - clock_.deadline());
    missed = clock_.follow(follower_.beat(), follower_.period());
    if (was_locked && missed == 0) exchange_.timing.sync_lateness.record(off);
    if (was_locked && off > clock_.period() / 10) ++status_.cycles_late;
  } else {
    const Time now = port_.now();
    follower_.on_silence(now, network_.nodes());
    missed = clock_.skip_missed(now - follower_.patience());
    status_.cycles_missed += was_locked;
    // After a stall the deadline may lie in the future, and a SYNC may come before it.
    sync_sent_ = std::min(clock_.deadline(), now);
  }
  if (missed != 0) {
    if (was_locked) record_skipped(missed);
    note_missed(missed, port_.now());
  }
  react_to_sync();
  look_at_wire();
}

/// Applies the reaction to the loss of SYNC that the network file configures.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::react_to_sync() noexcept {
  if (follower_.lost() == sync_lost_) return;
  sync_lost_ = follower_.lost();
  status_.sync_losses += sync_lost_;
  if (options_.observe || stop_.stage() != StopStage::running) return;
  switch (plan_.cycle.on_sync_loss) {
    case SyncLoss::hold:
      return;  // outputs_rest() holds the outputs
    case SyncLoss::fallback:
      return take_fallbacks();
    case SyncLoss::stop:
      sync_lost_ ? network_.on_sync_loss() : network_.on_sync_back();
      return;
  }
}

template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::take_fallbacks() noexcept {
  if (!sync_lost_) {
    call_off_fallbacks();
    return pdos_.outputs().hear_again();
  }
  pdos_.outputs().fall_back();
  fallbacks_.begin(pdos_.outputs());
}

/// Fallbacks that are not yet written must not reach a drive that is commanded again or is being
/// stopped.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::call_off_fallbacks() noexcept {
  fallbacks_.stop();
  network_.withdraw(FallbackWriter::request_id);
}

template <Port P, FrontLink L, Services S>
SyncState BusLoop<P, L, S>::sync_state() const noexcept {
  if (!follower_.used()) return plan_.cycle.sync ? SyncState::made : SyncState::none;
  if (follower_.lost()) return SyncState::lost;
  return follower_.waiting() ? SyncState::awaited : SyncState::locked;
}

template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::outputs_rest() const noexcept {
  return sync_lost_ && plan_.cycle.on_sync_loss == SyncLoss::hold &&
         stop_.stage() == StopStage::running;
}

/// Begins the beat: sends the master's SYNC, or notes whether the followed SYNC came.
template <Port P, FrontLink L, Services S>
void BusLoop<P, L, S>::begin_beat() noexcept {
  const bool heard = follower_.used() ? followed_ : send_sync();
  pdos_.inputs().begin(clock_.cycle(), sync_sent_, heard);
  status_.beats += heard;
  if (starved_ >= patience_with_services) relieve_services();
}

/// Returns false if a SYNC is due and was not sent.
template <Port P, FrontLink L, Services S>
bool BusLoop<P, L, S>::send_sync() noexcept {
  if (!plan_.cycle.sync || options_.observe) return true;
  if (network_.take_sync_restart()) counter_.restart();
  if (silent() || !hold_.open(network_.nodes())) return false;
  const Frame sync = counter_.used() ? sync_frame(plan_.cycle.sync_cob_id, counter_.next())
                                     : sync_frame(plan_.cycle.sync_cob_id);
  if (send({&sync, 1}) != 1) return false;
  counter_.sent();
  gate_.sent(sync_sent_);
  return true;
}

}  // namespace takt
