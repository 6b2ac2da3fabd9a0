#pragma once
#include <span>

#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"

namespace takt {

/// Returns true if the node is a CiA 402 drive, according to `profile:` of the network file, else
/// the device file.
bool is_cia402(const NodeSource& node);

/// Warns of questions that the network file leaves open for CiA 402 drives: which object sets the
/// mode of operation of an axis, and what the other drives do when one drive is lost.
void ask_about_drives(std::span<const NodePdos> nodes, NetworkReport& report);

}  // namespace takt
