#pragma once
#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"

namespace takt {

/// Reports entries of `safe_values` and `units: objects:` that would have no effect: objects that
/// the device does not have or that no RPDO of the network file carries, and values that do not
/// fit.
void check_node_values(const NodePdos& node, NetworkReport& report);

}  // namespace takt
