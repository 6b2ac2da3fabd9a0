#pragma once
#include <span>

#include "eds_parser/cob_ids.hpp"
#include "eds_parser/network_report.hpp"
#include "eds_parser/network_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// When the application can compute: between the publication of the image of SYNC k and the last
/// moment for its outputs.
struct TimeBudget {
  Time inputs_wire{};  ///< SYNC and all synchronous TPDOs, worst stuffing
  Time
      outputs_wire{};  ///< RPDOs, worst stuffing; event-driven ones at most a quarter of the period
  Time earliest{};  ///< worst-case arrival of the last input after SYNC, if devices answer at once
  Time latest{};    ///< output deadline
  bool next_sync = true;  ///< outputs act at SYNC k+1; false: at k+2
};

TimeBudget time_budget(const BusPlan& plan) noexcept;

/// SYNC, the PDOs, and the quiet before the next SYNC are not longer than the period; `taktd`
/// refuses a network where they are.
bool fits_period(const BusPlan& plan) noexcept;

/// Fills `plan.cycle` but for what `spec` says directly; `plan.pdos` are there. Reports cycles that
/// can't fit.
void compile_cycle(const NetworkSpec& spec, std::span<const NodePdos> nodes, BusPlan& plan,
                   NetworkReport& report);

}  // namespace takt
