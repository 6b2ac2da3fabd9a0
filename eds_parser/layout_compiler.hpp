#pragma once
#include <span>
#include <string>
#include <string_view>

#include "eds_parser/cob_ids.hpp"
#include "eds_parser/network_report.hpp"
#include "eds_parser/network_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Fills `plan.pdos` and `plan.layout` from the effective PDOs; `plan.nodes` and
/// `plan.cycle.period` are already there. `nodes` are in the order of `plan.nodes`.
void compile_layout(std::span<const NodePdos> nodes, BusPlan& plan, NetworkReport& report);

/// `Position actual value` -> `position_actual_value`. Never empty, never longer than 60.
std::string snake_case(std::string_view text);

}  // namespace takt
