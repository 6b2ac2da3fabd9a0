#pragma once
#include <cstdint>

#include "eds_parser/values/time.hpp"
#include "master/core/event_queue.hpp"
#include "master/rt/exchange/status_board.hpp"
#include "master/rt/port.hpp"

namespace takt {

/// Counts the periods without SYNC and reports them with their cause. Bus thread only.
class MissedCycles {
 public:
  /// Keeps references to both arguments.
  MissedCycles(EventQueue& events, BusStatus& status) noexcept : events_{events}, status_{status} {}

  /// Notes periods that the loop has skipped because it was late.
  void skip(std::uint64_t periods, Time now) noexcept {
    status_.cycles_missed += periods;
    announce(periods, MissedBecause::late, now);
  }
  /// Notes a period in which the SYNC of another device did not come.
  void unheard() noexcept { ++status_.cycles_missed; }

  /// Notes a cycle that sends nothing, because earlier frames may still be in the interface.
  void hold(const PortCondition& condition) noexcept {
    set_cause(condition);
    ++held_;
    ++status_.cycles_missed;
  }
  /// Reports the held cycles, when the loop sends again.
  void release(Time now) noexcept {
    if (held_ == 0) return;
    announce(held_, because_, now);
    held_ = 0;
  }
  /// Notes whether this thread was late in the newest cycle, before the image was published.
  void note_lateness(bool late) noexcept { late_cycle_ = late; }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(held_, because_, late_cycle_);
  }

 private:
  /// A late cycle explains only the cycle that follows it. A controller error explains all held
  /// cycles, because the controller may report it some cycles later.
  void set_cause(const PortCondition& condition) noexcept {
    if (held_ != 0 && because_ == MissedBecause::wire_blocked) return;
    because_ = MissedBecause::not_seen;
    if (held_ == 0 && late_cycle_) because_ = MissedBecause::sent_late;
    if (condition.bus_off || condition.error_passive) because_ = MissedBecause::wire_blocked;
  }
  void announce(std::uint64_t periods, MissedBecause cause, Time now) noexcept {
    events_.push({.when = now,
                  .kind = EventKind::cycles_missed,
                  .detail = static_cast<std::uint32_t>(cause),
                  .value = static_cast<std::int64_t>(periods)});
  }

  EventQueue& events_;
  BusStatus& status_;
  std::uint64_t held_ = 0;  ///< cycles held back since frames were last sent
  MissedBecause because_ = MissedBecause::not_seen;
  bool late_cycle_ = false;
};

}  // namespace takt
