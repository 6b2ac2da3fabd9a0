#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/time.hpp"
#include "master/core/event_queue.hpp"
#include "master/core/node_status.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Keeps the cycles to the SYNC of another device: which frames begin one, when the next is due,
/// and whether it is lost. The producer's period is measured, for its clock is not ours. CiA 301,
/// 7.2.5. Bus thread only.
class SyncFollower {
 public:
  /// Keeps a reference to the queue.
  SyncFollower(const CyclePlan& plan, EventQueue& events) noexcept;

  bool used() const noexcept { return used_; }
  bool is_sync(const Frame& frame) const noexcept { return used_ && frame.id == id_ && !frame.rtr; }

  void on_sync(const StampedFrame& sync) noexcept;
  /// A SYNC has come that begins the next cycle.
  bool arrived() const noexcept { return arrival_.has_value(); }
  Time arrival() const noexcept { return *arrival_; }
  /// Its time, once.
  Time take() noexcept { return *std::exchange(arrival_, std::nullopt); }
  /// When the newest was due: its arrival, unless that was an exception among punctual ones.
  Time beat() const noexcept { return beat_; }

  /// A cycle begins without SYNC. While nodes boot the first one is not missed yet.
  void on_silence(Time now, std::span<const NodeStatus> nodes) noexcept;

  /// None comes, or none has come by the time that it should have.
  bool lost() const noexcept { return state_ == State::lost; }
  /// Every SYNC of the last while came.
  bool locked() const noexcept { return state_ == State::locked; }
  /// None has come yet, and it is not missed either.
  bool waiting() const noexcept { return state_ == State::waiting; }
  Time period() const noexcept { return period_; }  ///< measured
  /// So long after its time a cycle begins without SYNC.
  Time patience() const noexcept;
  /// The same as a time, for a SYNC that is expected then; not just before the time-out.
  Time end_of_wait(Time expected) const noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(state_, arrival_, last_, idle_since_, counter_, jumped_, early_, late_, odd_, odd_told_);
    if (!used_) return;
    state(beat_);
    state.period(period_);
  }

 private:
  enum class State : std::uint8_t {
    waiting,  ///< for the first one
    locked,
    lost,
  };

  bool too_early(Time interval, Time when) noexcept;
  void check_counter(const Frame& frame, Time when) noexcept;
  void measure(Time interval, Time when) noexcept;
  void place(Time when) noexcept;
  void lock(Time when) noexcept;
  void tell(EventKind kind, Time now, std::int64_t value, std::uint32_t detail = 0) noexcept;

  bool used_;
  CobId id_;
  Time declared_;
  Time tolerance_;
  Time timeout_;
  SyncLoss reaction_;
  std::uint8_t overflow_;
  EventQueue& events_;

  State state_ = State::waiting;
  std::optional<Time> arrival_;  ///< of the SYNC that begins the next cycle
  std::optional<Time> last_;
  std::optional<Time> idle_since_;  ///< no node boots any more, and no SYNC yet
  Time period_;
  Time beat_{};
  std::uint8_t counter_ = 0;  ///< of the newest; 0: not known
  bool jumped_ = false;
  bool late_ = false;       ///< the newest was
  std::uint8_t early_ = 0;  ///< good ones until the next early one is told
  std::uint8_t odd_ = 0;    ///< intervals in a row that are not the declared period
  bool odd_told_ = false;
};

}  // namespace takt
