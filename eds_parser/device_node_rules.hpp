#pragma once
#include "eds_parser/effective_pdo.hpp"
#include "eds_parser/network_report.hpp"

namespace takt {

/// The part of judge_by_device_data() that has nothing to do with PDOs; the node has an entry.
void judge_node_by_device_data(const NodeSource& node, NetworkReport& report);

}  // namespace takt
