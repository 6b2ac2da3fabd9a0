#pragma once
#include <span>

#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/network_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Fills `plan.pdos` and `plan.layout` from the effective PDOs. `plan.nodes` and
/// `plan.cycle.period` must be complete. `nodes` must have the order of `plan.nodes`.
void compile_layout(std::span<const NodePdos> nodes, BusPlan& plan, NetworkReport& report);

}  // namespace takt
