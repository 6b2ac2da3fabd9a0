#pragma once
#include <span>
#include <string>
#include <string_view>

#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/network_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Fills `plan.pdos` and `plan.layout` from the effective PDOs. `plan.nodes` and
/// `plan.cycle.period` must be complete. `nodes` must have the order of `plan.nodes`.
void compile_layout(std::span<const NodePdos> nodes, BusPlan& plan, NetworkReport& report);

/// Converts a name: `Position actual value` becomes `position_actual_value`. The result is never
/// empty and has at most 60 characters.
std::string snake_case(std::string_view text);

}  // namespace takt
