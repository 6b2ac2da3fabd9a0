#pragma once
#include <string>
#include <vector>

#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"

namespace takt {

/// Reports as errors the settings that the device of a node can't fulfil according to its device
/// data: its node-ID, heartbeat times, transmission types, event timers, remote requests, mappings,
/// inhibit times, and its role as SYNC producer (`sync_source` of the network file, or an `sdo`
/// entry). Each error names the entry and its reason.
void judge_by_device_data(const NodePdos& node, const MasterSpec& master, NetworkReport& report);

/// Does the part of judge_by_device_data() that does not concern PDOs. The node must have an entry
/// of the device data.
void judge_node_by_device_data(const NodeSource& node, NetworkReport& report);

struct NumberRange;

/// Returns the content of the device data entry of a node as lines of text for the user. The result
/// is empty if the node has no entry.
std::vector<std::string> device_notes(const NodePdos& node);

/// Returns the ranges as text: "1..240, 254, 255".
std::string list_of(const std::vector<NumberRange>& ranges);

}  // namespace takt
