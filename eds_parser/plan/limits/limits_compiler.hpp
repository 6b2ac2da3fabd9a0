#pragma once
#include <span>

#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Fills `plan.limits` from `limits:` of the nodes. `plan.layout` and `plan.cycle.period` must be
/// complete. `nodes` must have the order of `plan.nodes`.
void compile_limits(std::span<const NodePdos> nodes, BusPlan& plan, NetworkReport& report);

}  // namespace takt
