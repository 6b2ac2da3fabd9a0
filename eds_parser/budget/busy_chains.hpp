#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "eds_parser/budget/cycle_frames.hpp"

namespace takt {

/// Computes how long the bus may be busy without a pause: since SYNC, since the outputs of an
/// earlier cycle, or for many cycles.
class BusyChains : protected CycleFrames {
 protected:
  using CycleFrames::CycleFrames;

  /// A period in which the bus is busy without a pause before one frame of the cycle. The bus is
  /// busy with the frames that certainly go before it, and with the frames of higher priority that
  /// devices send outside the cycle in this period.
  struct Busy {
    std::size_t at = 0;  ///< frames at lower positions of `frames_` go first
    Time since{};        ///< begin of the period
    Time work{};         ///< bus time of the frames that certainly go before the frame
    Time own{};          ///< bus time of the frame itself
    std::optional<std::size_t> input{};  ///< for a TPDO: number of the SYNC that the TPDO follows
    bool output = false;
    int rounds = 0;  ///< rounds of SDO requests whose answers may come; 0 = no limit
  };

  /// The way in which the analysis treats outputs that may end after the next SYNC is due. SYNC
  /// then waits behind them in the same transmit queue.
  enum class LateSync : std::uint8_t {
    in_time,      ///< no output ends that late
    follows_up,   ///< a chain of late SYNCs, each followed by the device time
    at_any_time,  ///< each SYNC separately is as late as possible
  };

  std::optional<Time> end_of(const Busy& busy) const;

  /// Returns the bus time of the frames [first, end) of `frames_` that devices send outside the
  /// cycle within `within`. It includes only the SDO answers to `rounds` rounds of requests (0 = no
  /// limit). A round lasts one cycle or longer. A server is late by at most one round, and has no
  /// other request during this time.
  Time from_devices(std::size_t first, std::size_t end, int rounds, Time within) const;

  /// Returns the bus time of the frames that come with the outputs and with later SYNCs, and that
  /// go before a frame that has waited for `waited`.
  Time behind_next_sync(const Busy& busy, Time waited) const;

  static std::optional<Time> later(std::optional<Time> a, std::optional<Time> b) {
    return a && b ? std::optional{std::max(*a, *b)} : std::nullopt;
  }

  static std::optional<Time> sooner(std::optional<Time> a, std::optional<Time> b) {
    return a && b ? std::optional{std::min(*a, *b)} : a ? a : b;
  }

  /// Returns the busy period since the outputs `cycles` cycles ago. The bus is busy with these
  /// outputs, with SYNC and with all frames of the cycles between. If `services` is set, the period
  /// begins with the service frames that were queued before those outputs.
  Busy busy_since_outputs(std::size_t at, int cycles, bool services) const;

  /// Returns the busy period since the SYNC `cycles` cycles ago. It includes the device time.
  Busy busy_since_sync(std::size_t at, int cycles) const;

  /// Returns the busy period since the SYNC `cycles` cycles ago, with only as many service frames
  /// as fit, together with their answers, before the outputs of that cycle.
  Busy busy_until_outputs(std::size_t at, int cycles) const;

  /// Returns the additional bus time of a chain of late SYNCs: the device time of each cycle, the
  /// frame that may begin during it (in all cycles but one), and the frames that go before the
  /// lowest frame of the master's queue although they do not go before `at`.
  Time follow_up(const Busy& busy, int cycles) const;

  /// Returns the largest delay of SYNC while it waits behind the outputs of the previous cycle in
  /// the same transmit queue.
  Time sync_late() const noexcept {
    if (!plan_.cycle.makes_sync()) return Time{0};
    return std::max(std::max(outputs_end_, services_end_) - plan_.cycle.period, Time{0});
  }

  /// Returns whether the frame at `at` waits for all service frames, because no service frame has a
  /// lower priority. In one queue, all frames wait as long as the one with the lowest priority.
  bool waits_for_services(std::size_t at) const noexcept {
    return services_in_queue() && at >= lowest_service_;
  }

  /// Returns whether service frames delay the frame at `at`: because no service frame has a lower
  /// priority, or because the frame waits behind SYNC in the same transmit queue.
  bool services_count(std::size_t at) const noexcept {
    return waits_for_services(at) || (services_in_queue() && late_ == LateSync::follows_up);
  }

  Time outputs_wait() const noexcept {
    return std::max(services_end_ - plan_.cycle.output_deadline, Time{0});
  }

  /// Returns the bus time for which SYNC may have to wait. A service frame that follows the
  /// previous SYNC is still in the queue only if the period is short enough.
  Time sync_blocking() const noexcept {
    const Time begun = std::max(sync_blocking_, late_input_);
    const Time relieved = sync_late() + begun + sync_frame() + services_before_sync_;
    return begun + (relieved > plan_.cycle.period ? services_before_sync_ : Time{0});
  }

  bool inputs_may_follow_outputs() const noexcept {
    return sync_late() + sync_blocking() + sync_frame() + options_.device_time >
           plan_.cycle.output_deadline;
  }

  /// Returns the position of the frame with the lowest priority in the master's queue.
  std::size_t lowest_queued() const noexcept {
    return services_in_queue() ? std::max(lowest_output_, lowest_service_) : lowest_output_;
  }

  /// Returns the longest frame that may begin while the devices compute, unless the chain already
  /// counts it.
  Time gap_blocking() const {
    if (options_.device_time == Time{0}) return Time{0};
    const bool counted = services_in_queue() && late_ == LateSync::follows_up;
    return counted ? queue_blocking_ : outputs_blocking_;
  }

  /// Returns all busy periods that may precede the frame at `at`. If the bus is busy for longer
  /// than a cycle, the worst case may lie in any of these cycles. Returns std::nullopt if the bus
  /// may be busy for ever.
  std::optional<std::vector<Busy>> busy_before(std::size_t at) const;

  Time sync_jitter_{};  ///< jitter of the arrival of another device's SYNC
  Time outputs_end_{};  ///< latest end of the outputs
  Time services_end_{};
  Time late_input_{};  ///< the longest TPDO that may have begun just before the next SYNC
  LateSync late_ = LateSync::in_time;
};

}  // namespace takt
