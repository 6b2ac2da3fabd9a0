#pragma once
#include <vector>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt {

/// What was seen of the cycle while applications ask every node for objects all the time, and
/// servers answer late.
struct LoadedRun {
  std::vector<Time> worst;  ///< as BudgetRow::worst of SYNC and the PDOs that follow it; else 0
  std::uint64_t sdo_answers = 0;
  std::uint64_t late_syncs = 0;  ///< by a tenth of the period
};

/// The whole master and its devices in virtual time. `slowest`: of the SDO servers, each answer.
LoadedRun run_loaded(const LoadedNetwork& network, const BusBudget& budget, Time duration,
                     Time slowest, std::uint64_t seed);

}  // namespace takt
