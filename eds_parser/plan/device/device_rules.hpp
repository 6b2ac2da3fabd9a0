#pragma once
#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"

namespace takt {

/// Reports as errors the settings that the device of a node can't fulfil according to its device
/// data: its node-ID, heartbeat times, transmission types, event timers, remote requests, mappings,
/// inhibit times, and its role as SYNC producer (`sync_source` of the network file, or an `sdo`
/// entry). Each error names the entry and its reason.
void judge_by_device_data(const NodePdos& node, const MasterSpec& master, NetworkReport& report);

}  // namespace takt
