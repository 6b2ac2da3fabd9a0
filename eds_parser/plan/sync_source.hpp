#pragma once
#include <vector>

#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Compiles `sync_source`, its timeout and the reaction to a loss of SYNC, if the master does not
/// produce SYNC itself.
void compile_sync_source(const NetworkSpec& spec, const std::vector<NodePdos>& nodes, BusPlan& plan,
                         NetworkReport& report);

}  // namespace takt
