#pragma once
#include <iosfwd>
#include <span>
#include <string_view>

#include "eds_parser/budget/budget.hpp"
#include "eds_parser/budget/suggestions.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// For people: load, the frames of a cycle and the others with their margins, the verdict.
void print_budget_text(std::ostream& out, const BusPlan& plan, const BusBudget& budget);

/// One cycle as a picture: the frames as late as they can be.
void print_budget_timeline(std::ostream& out, const BusPlan& plan, const BusBudget& budget);

/// The same as an SVG file.
void print_budget_svg(std::ostream& out, const BusPlan& plan, const BusBudget& budget);

/// What would make it fit, a line each.
void print_suggestions(std::ostream& out, std::span<const Suggestion> suggestions);

/// One JSON document.
void print_budget_json(std::ostream& out, const BusPlan& plan, const BusBudget& budget,
                       std::span<const Suggestion> suggestions);

/// "receive window"; empty: there is no limit.
std::string_view name_of(BudgetLimit limit) noexcept;

}  // namespace takt
