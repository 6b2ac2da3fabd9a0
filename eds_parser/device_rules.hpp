#pragma once
#include "eds_parser/cob_ids.hpp"
#include "eds_parser/network_report.hpp"

namespace takt {

/// Refuses what the device of a node can't do by its device data: its node id, heartbeat times,
/// transmission types, event timers, remote requests, mappings, inhibit times, its part as SYNC
/// producer (`sync_source` of the network file, or an `sdo` entry). Each error names the entry and
/// its reason.
void judge_by_device_data(const NodePdos& node, const MasterSpec& master, NetworkReport& report);

}  // namespace takt
