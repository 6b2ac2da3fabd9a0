#pragma once
#include <functional>
#include <vector>

#include "eds_parser/budget/suggestions.hpp"

namespace takt {

/// Whether a network with these changes fits.
using ChangeFits = std::function<bool(const WhatIf&)>;

/// Two changes, or as many as it takes, that only together make a network fit; the cheapest first,
/// at most three. Each was tried; no more than a few hundred are.
std::vector<Suggestion> cheapest_combinations(const BusPlan& plan, const WhatIf& base,
                                              const ChangeFits& fits);

}  // namespace takt
