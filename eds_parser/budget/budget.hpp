#pragma once
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/budget/traffic.hpp"

namespace takt {

/// One kind of frame and its worst-case end on the wire.
struct BudgetRow {
  TrafficFrame frame;
  /// Latest end of the frame. For frames of the cycle, the time counts from SYNC, for others from
  /// the moment at which they are queued. Empty if there is no bound.
  std::optional<Time> worst;
  std::optional<Time> worst_in_burst;         ///< `worst` while every node sends an EMCY
  std::optional<Time> worst_behind_services;  ///< `worst` with service frames in one queue
  std::optional<Time> worst_steady;           ///< `worst` while no event-driven output changes
  Time limit{};                               ///< latest permitted end, for the reason `why`
  BudgetLimit why = BudgetLimit::none;
  Time cycle{};      ///< time of the next SYNC; 0 = not a frame of the cycle
  Time tolerance{};  ///< longest permitted delay of the next SYNC by the outputs

  bool fits() const noexcept { return within(worst) || is_late_by_changes_only(); }
  bool fits_in_burst() const noexcept { return within(worst_in_burst); }
  /// Returns whether this is an output that ends behind the next SYNC, but fits: SYNC may be late
  /// by the tolerance, or by more if all event-driven outputs change at once.
  bool is_behind_sync() const noexcept { return fits() && cycle != Time{0} && *worst > cycle; }
  /// Returns the time that is left after the end of the frame until its limit or until the next
  /// SYNC, whichever comes first; negative if the frame ends later. Returns std::nullopt if the
  /// frame has neither a limit nor a next SYNC, if its end has no bound, and for SYNC itself.
  std::optional<Time> margin() const noexcept;

  /// Returns whether this is an output that delays the next SYNC by more than the tolerance only if
  /// all event-driven outputs change at once. Event-driven outputs have no deadline themselves.
  bool is_late_by_changes_only() const noexcept {
    return frame.is_output() && worst && !within(worst) && meets_limit(*worst) &&
           within(worst_steady);
  }

 private:
  bool meets_limit(Time end) const noexcept { return why == BudgetLimit::none || end <= limit; }
  bool within(const std::optional<Time>& end) const noexcept {
    return end && meets_limit(*end) && (cycle == Time{0} || *end <= cycle + tolerance);
  }
};

/// The result of the check whether the frames of a network fit its bus.
struct BusBudget {
  BusLoad load{};
  std::vector<BudgetRow> rows;  ///< rows in order of priority
  /// Largest number of SDO requests with their answers in one `service_round`.
  unsigned service_dialogues = 0;
  Time service_round{};  ///< one cycle, or a few cycles that have room for a request
  std::vector<std::string> assumptions{};  ///< one sentence each
  bool refused = false;                    ///< `taktd` refuses this plan, see fits_period()

  /// Returns whether all frames fit if no node sends an EMCY. Devices send EMCYs only when
  /// something is wrong already, and the worst effect of a burst is a late PDO that is marked as
  /// missing.
  bool fits() const noexcept;
  bool fits_in_burst() const noexcept;
  /// Returns whether all frames fit, except in a cycle in which all event-driven outputs change.
  bool fits_but_for_changes() const noexcept;
  /// Returns the frame with the smallest margin, or null if no frame has a margin.
  const BudgetRow* tightest() const noexcept;
  /// Returns the longest time by which the outputs can delay the next SYNC.
  Time sync_delay() const noexcept;
  /// Returns the longest time by which service frames, and outputs that follow them, can delay the
  /// next SYNC. Returns std::nullopt if there is no bound.
  std::optional<Time> sync_delay_behind_services() const noexcept;
};

BusBudget bus_budget(const BusPlan& plan, const BudgetOptions& options = {});

/// Returns only the verdict of bus_budget(), which takes less time.
bool bus_fits(const BusPlan& plan, const BudgetOptions& options = {});

/// Returns the greatest number of service frames in a cycle with which everything fits, from 1 to
/// that of the plan. Returns std::nullopt if not even one service frame fits.
std::optional<std::uint16_t> fitting_service_frames(const BusPlan& plan,
                                                    const BudgetOptions& options = {});

}  // namespace takt
