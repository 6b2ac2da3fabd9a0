#pragma once
#include <vector>

#include "eds_parser/cob_ids.hpp"
#include "eds_parser/network_report.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Who makes SYNC, where that is not the master: `sync_source`, its time-out and what its loss
/// does.
void compile_sync_source(const NetworkSpec& spec, const std::vector<NodePdos>& nodes, BusPlan& plan,
                         NetworkReport& report);

}  // namespace takt
