#pragma once
#include <functional>
#include <vector>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/budget/plan_changes.hpp"

namespace takt {

/// Returns the plan of the changed network, or std::nullopt if that cannot be compiled.
using TryNetwork = std::function<std::optional<BusPlan>(const WhatIf&)>;

/// Returns the changes that make an overloaded network fit, the cheapest first: fewer service
/// frames, other identifiers, longer inhibit times, TPDOs at every second SYNC, a longer period, a
/// higher bit rate. Each change was tried. `plan` already contains `changes`. If no single change
/// is enough, the result holds combinations of them. It is empty if combinations are not enough
/// either.
std::vector<Suggestion> cheapest_changes(const BusPlan& plan, const WhatIf& changes,
                                         const BudgetOptions& options,
                                         const TryNetwork& try_network);

}  // namespace takt
