#pragma once
#include "eds_parser/cob_ids.hpp"
#include "eds_parser/network_report.hpp"

namespace takt {

/// Complaints about `safe_values` and `units: objects:` that would have no effect: objects that the
/// device has not or that no RPDO of the network file carries, values that do not fit.
void check_node_values(const NodePdos& node, NetworkReport& report);

}  // namespace takt
