#pragma once
#include <functional>
#include <string>
#include <vector>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/budget/what_if.hpp"

namespace takt {

/// A change of a network file with which it fits: it was tried.
struct Suggestion {
  std::string text;  ///< "SYNC every 2300 us instead of 2000 us"
  WhatIf changes;
};

/// The plan of the network as it would be; none: it can't be compiled.
using TryNetwork = std::function<std::optional<BusPlan>(const WhatIf&)>;

/// What makes a network fit that does not, the cheapest first: other identifiers, longer inhibit
/// times, TPDOs in every second SYNC, a longer period, a higher bit rate. `changes` are in force
/// already. Where none of these alone is enough: combinations. Empty: nor are they.
std::vector<Suggestion> cheapest_changes(const BusPlan& plan, const WhatIf& changes,
                                         const BudgetOptions& options,
                                         const TryNetwork& try_network);

}  // namespace takt
