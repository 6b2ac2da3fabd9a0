#pragma once
#include <functional>
#include <vector>

#include "eds_parser/budget/suggestions.hpp"

namespace takt {

/// Returns true if a network with these changes fits.
using ChangeFits = std::function<bool(const WhatIf&)>;

/// Returns at most three combinations of changes, the cheapest first. Each combination has two or
/// more changes that make the network fit only together. All of them were tried; the search tries a
/// few hundred combinations at most.
std::vector<Suggestion> cheapest_combinations(const BusPlan& plan, const WhatIf& base,
                                              const ChangeFits& fits);

}  // namespace takt
