#pragma once
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/budget/load.hpp"
#include "eds_parser/budget/traffic.hpp"

namespace takt {

/// One kind of frame, and when it is through.
struct BudgetRow {
  TrafficFrame frame;
  /// End of the frame at the latest: of those in the cycle after SYNC, of others after being
  /// queued. None: there is no bound.
  std::optional<Time> worst;
  std::optional<Time> worst_in_burst;         ///< the same while every node sends an EMCY
  std::optional<Time> worst_behind_services;  ///< the same while service frames wait in its queue
  std::optional<Time> worst_steady;           ///< the same while no event-driven output changes
  Time limit{};                               ///< as `why` says
  BudgetLimit why = BudgetLimit::none;
  Time cycle{};      ///< in the cycle: the next SYNC; 0: not in it
  Time tolerance{};  ///< outputs may delay SYNC by so much

  bool fits() const noexcept { return within(worst) || is_late_by_changes_only(); }
  bool fits_in_burst() const noexcept { return within(worst_in_burst); }

  /// An output that ends behind the next SYNC by more than is tolerated, though only if all
  /// event-driven outputs change at once: it has no deadline of its own.
  bool is_late_by_changes_only() const noexcept {
    const bool output = frame.in_cycle && frame.kind == Traffic::rpdo;
    return output && worst && !within(worst) && meets_limit(*worst) && within(worst_steady);
  }

 private:
  bool meets_limit(Time end) const noexcept { return why == BudgetLimit::none || end <= limit; }
  bool within(const std::optional<Time>& end) const noexcept {
    return end && meets_limit(*end) && (cycle == Time{0} || *end <= cycle + tolerance);
  }
};

/// Whether the frames of a network fit its bus.
struct BusBudget {
  BusLoad load{};
  std::vector<BudgetRow> rows;     ///< by priority
  unsigned service_dialogues = 0;  ///< a `service_round`
  Time service_round{};
  std::vector<std::string> assumptions{};  ///< a sentence each
  bool refused = false;                    ///< by `taktd`, see fits_period()

  /// Without EMCYs: devices send them when something is wrong already, and a PDO that is late
  /// behind a burst of them is marked as missing and nothing worse.
  bool fits() const noexcept;
  bool fits_in_burst() const noexcept;
  /// It fits, but for a cycle in which all event-driven outputs change.
  bool fits_but_for_changes() const noexcept;
  /// By which the outputs can delay the next SYNC.
  Time sync_delay() const noexcept;
  /// By which service frames, and outputs behind them, can delay the next SYNC. None: no bound.
  std::optional<Time> sync_delay_behind_services() const noexcept;
};

BusBudget bus_budget(const BusPlan& plan, const BudgetOptions& options = {});

/// The verdict of bus_budget() alone, in less time.
bool bus_fits(const BusPlan& plan, const BudgetOptions& options = {});

}  // namespace takt
