#pragma once
#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "eds_parser/budget/cycle_bounds.hpp"
#include "eds_parser/budget/traffic.hpp"

namespace takt {

/// The frames of a bus that meet in a cycle. The functions of this class add the bus times of
/// frames that may go before another frame. They do not compute points in time.
class CycleFrames {
 protected:
  static constexpr std::size_t most_turns =
      240;  ///< greatest number of SYNCs until the cycles repeat
  static constexpr std::size_t any_cycle = 1'000'000;

  CycleFrames(const BusTraffic& traffic, const BusPlan& plan, const BudgetOptions& options,
              OtherTraffic other_traffic);

  bool comes_by_itself(const TrafficFrame& frame) const noexcept {
    return frame.by_itself() &&
           (frame.kind != Traffic::emcy || other_traffic_.emcys == Emcys::one_of_each);
  }

  /// Returns the bus time of the frames before position `end` that `counts` selects.
  template <class Counts>
  Time work_before(std::size_t end, Counts counts) const {
    Time sum{};
    for (std::size_t k = 0; k < end; ++k) {
      if (std::invoke(counts, frames_[k])) sum += frames_[k].burst * frames_[k].frame;
    }
    return sum;
  }

  /// Returns the bus time of the longest frame of lower priority than `at` that may just have
  /// begun.
  template <class MayBlock>
  Time blocking(std::size_t at, MayBlock may_block) const {
    Time longest{};
    for (std::size_t k = at + 1; k < frames_.size(); ++k) {
      if (std::invoke(may_block, frames_[k])) longest = std::max(longest, frames_[k].frame);
    }
    return longest;
  }

  /// Returns whether the cycle, with all frames that may go before its last one, needs the whole
  /// bus.
  bool is_overloaded() const noexcept;
  bool has_turn(const TrafficFrame& frame, std::size_t cycle) const noexcept;
  Time by_themselves(std::size_t first, std::size_t end, Time within) const;
  /// Returns the bus time of the master's frames outside the cycle that are sent before `at`. The
  /// master sends them when it no longer waits for a late TPDO.
  Time by_master(std::size_t at) const { return work_before(at, &TrafficFrame::is_service); }
  Time inputs_before(std::size_t at, std::size_t cycle) const {
    return work_before(
        at, [&](const TrafficFrame& frame) { return frame.is_input() && has_turn(frame, cycle); });
  }
  /// Returns the bus time of the outputs that go before a TPDO that is still waiting when they are
  /// sent. In the TPDO's own cycle an output of lower priority may have begun, too.
  Time outputs_before(std::size_t at, std::size_t cycles_later) const;
  /// Returns the bus time of the service frames that the master sends in `cycles` cycles. The
  /// master sends one only if it and its answer fit in before the outputs. If no cycle has room for
  /// that, the master sends one in every `cycles_to_relief` cycles.
  Time services_in(int cycles) const noexcept;
  /// Returns the bus time of the service frames that the master sends in a cycle in which it waits
  /// for late TPDOs until its receive window ends.
  Time services_behind_window() const noexcept;
  /// Returns whether a cycle has room for a request with its answer.
  bool has_room_for_services() const noexcept { return room_for_services() >= longest_service_; }
  /// Returns the bus time of the SDO answers to all requests that the master sends in `rounds`
  /// rounds of services; see BusTraffic::service_round.
  Time answers_in(int rounds) const {
    return rounds * work_before(frames_.size(), &TrafficFrame::is_answer);
  }
  /// Returns the bus time of the SDO answers to requests of an earlier round: at most one from each
  /// node.
  Time late_answers() const noexcept;
  bool services_in_queue() const noexcept {
    return other_traffic_.services == Services::in_queue && services_work_ > Time{0};
  }
  Time sync_frame() const noexcept { return sync_ ? frames_[*sync_].frame : Time{0}; }
  /// Returns the time to subtract from times so that they count from the arrival of a SYNC that the
  /// master follows.
  Time origin() const noexcept { return plan_.cycle.makes_sync() ? Time{0} : sync_frame(); }

  /// Returns the number of cycles that the analysis examines.
  std::size_t turns() const noexcept { return turns_ < most_turns ? turns_ : most_turns; }

  const std::vector<TrafficFrame>& frames_;
  const BusPlan& plan_;
  const BudgetOptions& options_;
  OtherTraffic other_traffic_;
  Time bit_;
  std::optional<std::size_t> sync_;
  std::vector<std::size_t> queue_;  ///< outputs in the order of sending
  std::size_t lowest_output_ = 0;
  Time inputs_work_{};
  Time outputs_work_{};
  Time outputs_blocking_{};
  Time queue_blocking_{};  ///< longest frame that may delay service frames and outputs
  Time sync_blocking_{};
  Time services_work_{};  ///< bus time of all service frames, each once
  Time longest_service_{};
  std::size_t lowest_service_ = 0;
  Time services_before_sync_{};  ///< bus time of the master's service frames that go before SYNC

 private:
  /// Returns the time for requests in a cycle. The same time is left for their answers.
  Time room_for_services() const noexcept;
  Time services_due(int cycles) const noexcept;
  /// Finds SYNC, the queue of the outputs, and the frames that may block them.
  void find_ends_of_cycle();
  /// Counts the cycles until they repeat. Cycles differ from each other if the SYNC counter
  /// determines in which of them a TPDO is sent.
  void count_turns();

  std::size_t turns_ = 1;
};

}  // namespace takt
