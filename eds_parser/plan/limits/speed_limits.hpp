#pragma once
#include "eds_parser/plan/limits/limit_table.hpp"
#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Compiles `limits:` of a node that is a speed axis: `velocity` and `acceleration` of its set
/// speed, in its unit and for both directions. Reports the limits that an axis without a position
/// can't have.
void compile_speed_limits(const NodeSpec& node, SpeedAxisPlan& axis, BusPlan& plan,
                          LimitTable& table, NetworkReport& report);

}  // namespace takt
