#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "eds_parser/budget/cycle_frames.hpp"

namespace takt {

/// How long the bus may be busy without a pause: since SYNC, since the outputs of a cycle before,
/// or for many cycles.
class BusyChains : protected CycleFrames {
 protected:
  using CycleFrames::CycleFrames;

  /// Frames that come by themselves since then, up to a priority, delay one of the cycle. The bus
  /// is busy with these and with what certainly goes before it all the time.
  struct Busy {
    std::size_t at = 0;  ///< what is before it in `frames_` goes first
    Time since{};
    Time work{};  ///< that certainly goes before it
    Time own{};
    std::optional<std::size_t> input{};  ///< of a TPDO: the SYNC that it follows
    bool output = false;
    int rounds = 0;  ///< no more SDO answers than those to so many rounds of requests; 0: any
  };

  /// What to make of it that outputs may end behind the next SYNC, which leaves the same queue.
  enum class LateSync : std::uint8_t {
    in_time,      ///< they do not
    follows_up,   ///< a chain of them, each with the time that the devices take to answer
    at_any_time,  ///< each for itself is as late as it may
  };

  std::optional<Time> end_of(const Busy& busy) const;

  /// What comes by itself, with no more SDO answers than those to so many rounds of requests (0:
  /// any). A round is that of one cycle, or longer. A server is late by one of them at most, and
  /// has no other request then.
  Time from_devices(std::size_t first, std::size_t end, int rounds, Time within) const;

  /// What comes with the outputs and the next SYNC, and goes before a frame that is as late.
  Time behind_next_sync(const Busy& busy, Time waited) const;

  static std::optional<Time> later(std::optional<Time> a, std::optional<Time> b) {
    return a && b ? std::optional{std::max(*a, *b)} : std::nullopt;
  }

  static std::optional<Time> sooner(std::optional<Time> a, std::optional<Time> b) {
    return a && b ? std::optional{std::min(*a, *b)} : a ? a : b;
  }

  /// The bus has been busy since the outputs so many cycles ago: with them, with SYNC, and with all
  /// of the cycles between; with the service frames before them, or as if there were none.
  Busy busy_since_outputs(std::size_t at, int cycles, bool services) const;

  /// The bus has been busy since SYNC so many cycles ago, and the devices have computed since.
  Busy busy_since_sync(std::size_t at, int cycles) const;

  /// The bus has been busy since SYNC, too, but with no more service frames than fitted in before
  /// those outputs with their answers.
  Busy busy_until_outputs(std::size_t at, int cycles) const;

  /// In each of the cycles the time that devices need, and what may begin in it, but for the last
  /// beginning; and what goes before the lowest of the master's queue, though not before `at`.
  Time follow_up(const Busy& busy, int cycles) const;

  /// SYNC waits behind the outputs before it: they leave one queue.
  Time sync_late() const noexcept {
    if (!plan_.cycle.makes_sync()) return Time{0};
    return std::max(std::max(outputs_end_, services_end_) - plan_.cycle.period, Time{0});
  }

  /// The frames of one queue go as far down as its lowest.
  bool waits_for_services(std::size_t at) const noexcept {
    return services_in_queue() && at >= lowest_service_;
  }

  /// Or what waits for SYNC, which leaves that queue.
  bool services_count(std::size_t at) const noexcept {
    return waits_for_services(at) || (services_in_queue() && late_ == LateSync::follows_up);
  }

  Time outputs_wait() const noexcept {
    return std::max(services_end_ - plan_.cycle.output_deadline, Time{0});
  }

  /// What SYNC may wait for. A service frame that goes out right behind the SYNC before is still
  /// there only if the period is that short.
  Time sync_blocking() const noexcept {
    const Time begun = std::max(sync_blocking_, late_input_);
    const Time relieved = sync_late() + begun + sync_frame() + services_before_sync_;
    return begun + (relieved > plan_.cycle.period ? services_before_sync_ : Time{0});
  }

  bool inputs_may_follow_outputs() const noexcept {
    return sync_late() + sync_blocking() + sync_frame() + options_.device_time >
           plan_.cycle.output_deadline;
  }

  /// The lowest of what leaves the master's queue.
  std::size_t lowest_queued() const noexcept {
    return services_in_queue() ? std::max(lowest_output_, lowest_service_) : lowest_output_;
  }

  /// What may begin while devices compute; in a chain that is not counted anyway.
  Time gap_blocking() const {
    if (options_.device_time == Time{0}) return Time{0};
    const bool counted = services_in_queue() && late_ == LateSync::follows_up;
    return counted ? queue_blocking_ : outputs_blocking_;
  }

  /// Where the bus is busy for longer than a cycle, the worst need not be in the first one.
  /// None: it may be busy for ever.
  std::optional<std::vector<Busy>> busy_before(std::size_t at) const;

  Time sync_jitter_{};  ///< of the arrival of another device's SYNC
  Time outputs_end_{};  ///< at the latest
  Time services_end_{};
  Time late_input_{};  ///< the longest TPDO that may have begun just before the next SYNC
  LateSync late_ = LateSync::in_time;
};

}  // namespace takt
