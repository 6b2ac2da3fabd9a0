#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/values/time.hpp"
#include "master/core/event_queue.hpp"
#include "master/core/node_status.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Follows the SYNC of another device: determines which frames begin a cycle, when the next one is
/// due, and whether SYNC is lost. The follower measures the producer's period, because the two
/// clocks differ. CiA 301, 7.2.5. Bus thread only.
class SyncFollower {
 public:
  /// Keeps a reference to the queue.
  SyncFollower(const CyclePlan& plan, EventQueue& events) noexcept;

  bool used() const noexcept { return used_; }
  bool is_sync(const Frame& frame) const noexcept { return used_ && frame.id == id_ && !frame.rtr; }

  void on_sync(const StampedFrame& sync) noexcept;
  /// Returns true if a SYNC has come that begins the next cycle.
  bool arrived() const noexcept { return arrival_.has_value(); }
  Time arrival() const noexcept { return *arrival_; }
  /// Returns the arrival of that SYNC and clears it.
  Time take() noexcept { return *std::exchange(arrival_, std::nullopt); }
  /// Returns the time at which the newest SYNC was due: its arrival, unless it was a single late
  /// one among punctual ones.
  Time beat() const noexcept { return beat_; }

  /// Notes that a cycle begins without SYNC. While nodes boot, a missing first SYNC does not count
  /// as lost yet.
  void on_silence(Time now, std::span<const NodeStatus> nodes) noexcept;

  /// Returns true if SYNC stopped coming, or if the first one did not come in time.
  bool lost() const noexcept { return state_ == State::lost; }
  /// Returns true while SYNC comes without a loss.
  bool locked() const noexcept { return state_ == State::locked; }
  /// Returns true before the first SYNC, while it is not yet overdue.
  bool waiting() const noexcept { return state_ == State::waiting; }
  Time period() const noexcept { return period_; }  ///< measured
  /// Returns the time after the expected SYNC at which a cycle begins without it.
  Time sync_wait() const noexcept;
  /// Returns the end of the wait for a SYNC that is expected at `expected`. The end never falls
  /// just before the time-out of SYNC.
  Time end_of_wait(Time expected) const noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(state_, arrival_, last_, idle_since_, counter_, jumped_, early_, late_, odd_,
          odd_reported_);
    if (!used_) return;
    state(beat_);
    state.period(period_);
  }

 private:
  enum class State : std::uint8_t {
    waiting,  ///< no SYNC has come yet
    locked,
    lost,
  };

  bool too_early(Time interval, Time when) noexcept;
  void check_counter(const Frame& frame, Time when) noexcept;
  void measure(Time interval, Time when) noexcept;
  void place(Time when) noexcept;
  void lock(Time when) noexcept;
  void announce(EventKind kind, Time now, std::int64_t value, std::uint32_t detail = 0) noexcept;

  bool used_;
  CobId id_;
  Time declared_;
  Time tolerance_;
  Time timeout_;
  SyncLoss reaction_;
  std::uint8_t overflow_;
  EventQueue& events_;

  State state_ = State::waiting;
  std::optional<Time> arrival_;  ///< arrival of the SYNC that begins the next cycle
  std::optional<Time> last_;
  std::optional<Time> idle_since_;  ///< since then no node boots, and no SYNC has come
  Time period_;
  Time beat_{};
  std::uint8_t counter_ = 0;  ///< counter of the newest SYNC; 0 if unknown
  bool jumped_ = false;
  bool late_ = false;       ///< the newest SYNC was late
  std::uint8_t early_ = 0;  ///< punctual SYNCs until the next early one is reported
  std::uint8_t odd_ = 0;    ///< intervals in a row that differ from the declared period
  bool odd_reported_ = false;
};

}  // namespace takt
