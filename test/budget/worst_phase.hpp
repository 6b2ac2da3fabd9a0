#pragma once
#include <vector>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/sim/random.hpp"

namespace takt {

struct PhaseOptions {
  Time device_time{};
  unsigned cycles = 100;
  bool emcys = false;      ///< one of each node, all at once
  double wire_errors = 0;  ///< share of the frames that are destroyed
};

/// What was seen of one row of the budget.
struct SeenRow {
  std::size_t frames = 0;
  Time worst{};  ///< as BudgetRow::worst: after SYNC, or after being queued
};

/// Lets the frames of a budget run over the bit-accurate bus, at the moments that hurt most: data
/// that stuff most, what comes by itself just before SYNC, the TPDOs and the outputs, as often as
/// its rows say. In the order of the rows.
std::vector<SeenRow> run_worst_phase(const BusPlan& plan, const BusBudget& budget,
                                     const PhaseOptions& options, sim::Random random);

}  // namespace takt
