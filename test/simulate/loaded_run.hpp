#pragma once
#include <vector>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt {

/// Observations of the cycle while applications permanently read objects of every node and the SDO
/// servers answer late.
struct LoadedRun {
  std::vector<Time> worst;  ///< as BudgetRow::worst, for SYNC and the PDOs that follow SYNC; else 0
  std::uint64_t sdo_answers = 0;
  std::uint64_t late_syncs = 0;  ///< SYNCs that were late by a tenth of the period
};

/// Runs the complete master and its devices in virtual time. `slowest` is the longest delay of an
/// answer of the SDO servers.
LoadedRun run_loaded(const LoadedNetwork& network, const BusBudget& budget, Time duration,
                     Time slowest, std::uint64_t seed);

}  // namespace takt
