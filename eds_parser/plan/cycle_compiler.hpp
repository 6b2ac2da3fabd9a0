#pragma once
#include <span>

#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/network_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// The time in which the application can compute: from the publication of the image of SYNC k to
/// the last moment for its outputs.
struct TimeBudget {
  Time inputs_wire{};  ///< time of SYNC and all synchronous TPDOs on the wire, with worst stuffing
  /// Time of the RPDOs on the wire, with worst stuffing. Event-driven RPDOs count for at most a
  /// quarter of the period.
  Time outputs_wire{};
  /// Worst-case arrival of the last input after SYNC, if all devices answer at once.
  Time earliest{};
  Time latest{};          ///< output deadline
  bool next_sync = true;  ///< Outputs act at SYNC k+1. If false, they act at SYNC k+2.
};

TimeBudget time_budget(const BusPlan& plan) noexcept;

/// Returns true if SYNC, the PDOs and the quiet time before the next SYNC fit into the period. Also
/// returns true if the network has no SYNC. `taktd` refuses a network for which this is false.
bool fits_period(const BusPlan& plan) noexcept;

/// Fills `plan.cycle`, except for the members that `spec` states directly. `plan.pdos` must be
/// complete. Reports cycles that can't fit.
void compile_cycle(const NetworkSpec& spec, std::span<const NodePdos> nodes, BusPlan& plan,
                   NetworkReport& report);

}  // namespace takt
