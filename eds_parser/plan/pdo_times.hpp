#pragma once
#include <cstdint>

#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"

namespace takt {

/// Warns of event timers that contradict the inhibit time, and of inhibit times that are shorter
/// than the frame on the wire. `bitrate` is in bit/s.
void judge_pdo_times(const NodePdos& node, std::uint32_t bitrate, NetworkReport& report);

}  // namespace takt
