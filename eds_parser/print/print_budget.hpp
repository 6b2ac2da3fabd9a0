#pragma once
#include <cstddef>
#include <iosfwd>
#include <ostream>
#include <span>
#include <string_view>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/budget/suggestions.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Prints the budget for the user: the verdict with the smallest margin and what is late, the load,
/// the frames of a cycle and the others with their margins.
void print_budget_text(std::ostream& out, const BusPlan& plan, const BusBudget& budget);

/// Prints one cycle as a picture in text of at most `width` columns where that is possible. Each
/// frame is as late as it can be.
void print_budget_timeline(std::ostream& out, const BusPlan& plan, const BusBudget& budget,
                           std::size_t width = 120);

/// Prints the picture of one cycle as an SVG file.
void print_budget_svg(std::ostream& out, const BusPlan& plan, const BusBudget& budget);

/// Prints the changes that would make the network fit, one line each.
void print_suggestions(std::ostream& out, std::span<const Suggestion> suggestions);

/// Prints the budget as one JSON document.
void print_budget_json(std::ostream& out, const BusPlan& plan, const BusBudget& budget,
                       std::span<const Suggestion> suggestions);

/// Returns for example "receive window"; empty if there is no limit.
std::string_view name_of(BudgetLimit limit) noexcept;

}  // namespace takt
