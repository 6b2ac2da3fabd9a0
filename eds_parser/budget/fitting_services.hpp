#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/budget/budget.hpp"

namespace takt {

/// Returns the greatest number of service frames in a cycle with which everything fits, from 1 to
/// that of the plan. Returns std::nullopt if not even one service frame fits.
std::optional<std::uint16_t> fitting_service_frames(const BusPlan& plan,
                                                    const BudgetOptions& options = {});

}  // namespace takt
