#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/event_queue.hpp"
#include "master/core/node_status.hpp"
#include "master/rt/beat/beat_clock.hpp"
#include "master/rt/beat/missed_cycles.hpp"
#include "master/rt/beat/sync_follower.hpp"
#include "master/rt/beat/sync_gate.hpp"
#include "master/rt/beat/sync_hold.hpp"
#include "master/rt/exchange/exchange.hpp"
#include "master/rt/machines/services.hpp"
#include "master/rt/port.hpp"
#include "master/wire/sync.hpp"

namespace takt {

/// Determines when the next SYNC is due, by the master's own clock or by the SYNC of another
/// device, whether SYNC may be sent, and which cycles were missed. Bus thread only.
class Beat {
 public:
  /// Keeps references to all arguments.
  Beat(const BusPlan& plan, EventQueue& events, BusStatus& status, TimingHistograms& timing);

  /// Starts the beat: the first SYNC is due one period after `now`.
  void start(Time now) noexcept;
  /// Ends this cycle.
  void next() noexcept { clock_.next(); }

  // The times of this cycle.
  std::uint64_t cycle() const noexcept { return clock_.cycle(); }
  Time period() const noexcept { return clock_.period(); }
  Time deadline() const noexcept { return clock_.deadline(); }  ///< when its SYNC was due
  Time sync_at() const noexcept { return sync_at_; }  ///< time of its SYNC; without SYNC, its begin
  Time next_deadline() const noexcept { return clock_.deadline() + clock_.period(); }
  Time outputs_due() const noexcept { return clock_.deadline() + plan_.output_deadline; }
  /// Returns the end of the receive window. The image is published at this time at the latest, even
  /// if PDOs are missing.
  Time window_end() const noexcept {
    return std::min(sync_at_ + plan_.receive_window, outputs_due());
  }
  /// Returns true if the time since SYNC is so long that this thread cannot have run all the time.
  /// The time-outs must take this absence into account before the state machines run again.
  bool stalled(Time now) const noexcept { return now - sync_at_ > longest_lapse * period(); }
  /// Returns the time for which this thread did not run before this SYNC; 0 if the time was so
  /// short that time-outs need not take it into account. Call this once a cycle.
  Time take_absence() noexcept;

  /// Waits until SYNC is due, or until the SYNC of another device arrives. Then decides whether
  /// frames may leave in this cycle. `drain()` takes the frames that have come.
  template <Port P, NodeServices S, class Drain>
  void await(P& port, const S& services, Drain drain) noexcept;
  bool wire_open() const noexcept { return wire_ == Wire::open; }  ///< frames may leave

  // The master's own SYNC.
  /// Returns true if SYNC may be sent, see SyncHold.
  template <NodeServices S>
  bool permits_sync(const S& services) noexcept {
    return hold_.is_open() || hold_.open(services.nodes());
  }
  Frame sync() const noexcept;
  void on_sync_sent() noexcept;
  void restart_counter() noexcept { counter_.restart(); }

  // The SYNC of another device.
  bool follows() const noexcept { return follower_.used(); }
  /// Takes a frame. Returns true if it is a SYNC that begins the next cycle.
  bool begins_cycle(const StampedFrame& stamped) noexcept;
  /// Returns true if a SYNC has come that begins the next cycle.
  bool next_sync_came() const noexcept { return follower_.arrived(); }
  /// Returns true if a SYNC began this cycle.
  bool began_by_sync() const noexcept { return began_ == Began::by_sync; }
  /// Returns true if this cycle has a SYNC: the one that began it, or one that this thread has
  /// found too late.
  bool has_sync() const noexcept { return began_ != Began::by_clock; }
  bool sync_lost() const noexcept { return follower_.lost(); }

  SyncState sync_state() const noexcept;
  Time sync_period() const noexcept { return follower_.period(); }  ///< of another device, measured

  /// Notes at which time the image was published, to explain the next cycle.
  void note_publication(Time now) noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(clock_, counter_, hold_, gate_, follower_, missed_, wire_, sync_at_, previous_sync_);
  }

 private:
  /// Number of stalls in a row after which the cycle begins, even if the thread is late again.
  static constexpr unsigned most_stalls = 16;
  /// Longest absence of this thread, in periods, that time-outs need not take into account.
  static constexpr int longest_lapse = 2;

  enum class Wire : std::uint8_t {
    open,
    held,  ///< earlier frames may still be in the interface, so this cycle sends nothing
  };
  enum class Began : std::uint8_t {
    by_clock,
    by_sync,
    after_sync,  ///< by the clock, because the SYNC was already too old when this thread found it
  };

  template <Port P>
  void await_deadline(P& port) noexcept;
  template <Port P, class Drain>
  void await_sync(P& port, std::span<const NodeStatus> nodes, Drain drain) noexcept;
  void open_or_hold_wire(const PortCondition& condition) noexcept;
  void begin(Time now) noexcept;
  std::uint64_t begin_by_sync(bool was_locked) noexcept;
  std::uint64_t begin_without_sync(Time now, std::span<const NodeStatus> nodes,
                                   bool was_locked) noexcept;
  void record_skipped(std::uint64_t periods) noexcept;

  const CyclePlan& plan_;
  BusStatus& status_;
  TimingHistograms& timing_;
  BeatClock clock_;
  SyncCounter counter_;
  SyncHold hold_;
  SyncGate gate_;
  SyncFollower follower_;
  MissedCycles missed_;
  Wire wire_ = Wire::open;
  Began began_ = Began::by_clock;
  Time sync_at_{};
  Time previous_sync_{};
};

template <Port P, NodeServices S, class Drain>
void Beat::await(P& port, const S& services, Drain drain) noexcept {
  if (follows()) {
    await_sync(port, services.nodes(), drain);
  } else {
    await_deadline(port);
  }
  if (gate_.doubtful(port.condition())) drain();  // the echo of SYNC may be among the frames
  open_or_hold_wire(port.condition());
}

inline void Beat::begin(Time now) noexcept {
  sync_at_ = now;
  const Time late = now - clock_.deadline();
  timing_.sync_lateness.record(late);
  if (late > clock_.period() / 10) ++status_.cycles_late;
}

/// Waits for the time of SYNC by the clock of the master. Periods that have passed are skipped.
template <Port P>
void Beat::await_deadline(P& port) noexcept {
  port.sleep_precisely_until(clock_.deadline());
  Time now = port.now();
  for (unsigned stalls = 0; stalls < most_stalls; ++stalls) {
    const std::uint64_t missed = clock_.skip_missed(now);
    if (missed == 0) break;
    record_skipped(missed);
    missed_.skip(missed, now);
    port.sleep_precisely_until(clock_.deadline());
    now = port.now();
  }
  begin(now);
}

/// Waits until shortly after the expected time of SYNC. If no SYNC comes, the cycle begins by the
/// master's own clock, so that services continue and the loss is detected.
template <Port P, class Drain>
void Beat::await_sync(P& port, std::span<const NodeStatus> nodes, Drain drain) noexcept {
  const bool was_locked = follower_.locked();
  const Time until = follower_.end_of_wait(clock_.deadline());
  Began without = Began::by_clock;
  for (bool more = follower_.arrived() || port.wait_frame(until); more;) {
    drain();
    if (!follower_.arrived()) {
      more = port.now() < until && port.wait_frame(until);
    } else if (port.now() - follower_.arrival() <= clock_.period() / 2) {
      break;
    } else {
      follower_.take();  // The SYNC is too old to begin a cycle; a newer one may be behind it.
      without = Began::after_sync;
    }
  }
  began_ = follower_.arrived() ? Began::by_sync : without;
  const std::uint64_t missed = began_ == Began::by_sync
                                   ? begin_by_sync(was_locked)
                                   : begin_without_sync(port.now(), nodes, was_locked);
  if (missed == 0) return;
  if (was_locked) record_skipped(missed);
  missed_.skip(missed, port.now());
}

inline Time Beat::take_absence() noexcept {
  const Time away = sync_at_ - std::exchange(previous_sync_, sync_at_) - clock_.period();
  return away > longest_lapse * clock_.period() ? away : Time{};
}

inline Frame Beat::sync() const noexcept {
  return counter_.used() ? sync_frame(plan_.sync_cob_id, counter_.next())
                         : sync_frame(plan_.sync_cob_id);
}

inline void Beat::on_sync_sent() noexcept {
  counter_.sent();
  gate_.sent(sync_at_);
}

inline bool Beat::begins_cycle(const StampedFrame& stamped) noexcept {
  if (!follower_.is_sync(stamped.frame)) return false;
  follower_.on_sync(stamped);
  return follower_.arrived();
}

/// Closes the wire for this cycle if earlier frames could not leave yet; otherwise opens it.
inline void Beat::open_or_hold_wire(const PortCondition& condition) noexcept {
  wire_ = gate_.open(condition, sync_at_) ? Wire::open : Wire::held;
  if (wire_ == Wire::open) {
    missed_.release(sync_at_);
  } else {
    missed_.hold(condition);
  }
}

inline void Beat::note_publication(Time now) noexcept {
  const Time late = std::max(sync_at_ - clock_.deadline(), now - window_end());
  missed_.note_lateness(late > clock_.period() / 4);
}

}  // namespace takt
