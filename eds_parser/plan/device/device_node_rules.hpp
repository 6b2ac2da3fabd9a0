#pragma once
#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/report/network_report.hpp"

namespace takt {

/// Does the part of judge_by_device_data() that does not concern PDOs. The node must have an entry
/// of the device data.
void judge_node_by_device_data(const NodeSource& node, NetworkReport& report);

}  // namespace takt
