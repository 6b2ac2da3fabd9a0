#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "eds_parser/budget/cycle_bounds.hpp"
#include "eds_parser/budget/traffic.hpp"

namespace takt {

/// The frames of a bus as they meet in a cycle: sums of those that may go before another, without
/// a word of when.
class CycleFrames {
 protected:
  static constexpr std::size_t most_turns = 240;  ///< SYNCs until the cycles repeat
  static constexpr std::size_t any_cycle = 1'000'000;

  CycleFrames(const BusTraffic& traffic, const BusPlan& plan, const BudgetOptions& options,
              Company company);

  bool is_input(const TrafficFrame& frame) const noexcept {
    return frame.in_cycle && frame.kind == Traffic::tpdo;
  }
  bool is_output(const TrafficFrame& frame) const noexcept {
    return frame.in_cycle && frame.kind == Traffic::rpdo;
  }
  /// What the master sends beside the cycle.
  bool is_service(const TrafficFrame& frame) const noexcept {
    return frame.from_master && !frame.in_cycle;
  }
  bool comes_by_itself(const TrafficFrame& frame) const noexcept {
    return frame.by_itself() &&
           (frame.kind != Traffic::emcy || company_.emcys == Emcys::one_of_each);
  }

  /// The longest frame of lower priority than `at` that may just have begun.
  template <class MayBlock>
  Time blocking(std::size_t at, MayBlock may_block) const {
    Time longest{};
    for (std::size_t k = at + 1; k < frames_.size(); ++k) {
      if (may_block(frames_[k])) longest = std::max(longest, frames_[k].frame);
    }
    return longest;
  }

  /// The cycle, and what may go before its last frame, need the whole bus.
  bool is_overloaded() const noexcept;
  bool has_turn(const TrafficFrame& frame, std::size_t cycle) const noexcept;
  Time by_themselves(std::size_t first, std::size_t end, Time within) const;
  /// The master waits no longer for what is late: what else it has to send comes.
  Time by_master(std::size_t at) const;
  Time inputs_before(std::size_t at, std::size_t cycle) const;
  /// What goes out with the outputs before a TPDO that is as late as they. In its own cycle one of
  /// lower priority may have begun.
  Time outputs_before(std::size_t at, std::size_t cycles_later) const;
  /// Service frames that the master hands over in so many cycles. It looks for room for each and
  /// its answer before the outputs; in cycles without any it sends one now and then.
  Time services_in(int cycles) const noexcept;
  /// The same of one cycle, if TPDOs that are late keep the master until the end of its window.
  Time services_behind_window() const noexcept;
  /// Cycles have room for a dialogue.
  bool has_room_for_services() const noexcept { return room_for_services() >= longest_service_; }
  bool is_answer(const TrafficFrame& frame) const noexcept {
    return frame.kind == Traffic::sdo && !frame.from_master;
  }
  /// SDO answers to the requests of so many rounds.
  Time answers_in(int rounds) const noexcept;
  /// Those to the requests of an earlier round: of each node one at most.
  Time late_answers() const noexcept;
  bool services_in_queue() const noexcept {
    return company_.services == Services::in_queue && services_work_ > Time{0};
  }
  Time sync_frame() const noexcept { return sync_ ? frames_[*sync_].frame : Time{0}; }
  /// As from the arrival of a SYNC that the master follows.
  Time origin() const noexcept { return plan_.cycle.makes_sync() ? Time{0} : sync_frame(); }

  /// So many cycles are looked at.
  std::size_t turns() const noexcept { return turns_ < most_turns ? turns_ : most_turns; }

  const std::vector<TrafficFrame>& frames_;
  const BusPlan& plan_;
  const BudgetOptions& options_;
  Company company_;
  Time bit_;
  std::optional<std::size_t> sync_;
  std::vector<std::size_t> queue_;  ///< outputs, as they go out
  std::size_t lowest_output_ = 0;
  Time inputs_work_{};
  Time outputs_work_{};
  Time outputs_blocking_{};
  Time queue_blocking_{};  ///< services and outputs
  Time sync_blocking_{};
  Time services_work_{};  ///< all kinds, once
  Time longest_service_{};
  std::size_t lowest_service_ = 0;
  Time services_before_sync_{};  ///< of the master, should one be there when SYNC comes

 private:
  /// For requests; as much is left for their answers.
  Time room_for_services() const noexcept;
  Time services_due(int cycles) const noexcept;
  /// SYNC, the queue of the outputs, and what may have begun when they are ready.
  void find_ends_of_cycle();
  /// The cycles differ where the turns of TPDOs are certain.
  void count_turns();

  std::size_t turns_ = 1;
};

}  // namespace takt
