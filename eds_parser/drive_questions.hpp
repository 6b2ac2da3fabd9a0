#pragma once
#include <span>

#include "eds_parser/cob_ids.hpp"
#include "eds_parser/network_report.hpp"

namespace takt {

/// By `profile:` of the network file, else by the device file.
bool is_cia402(const NodeSource& node);

/// Warns of what the network file leaves open for CiA 402 drives: who sets the mode of operation of
/// an axis, and what the other drives do when one is lost.
void ask_about_drives(std::span<const NodePdos> nodes, NetworkReport& report);

}  // namespace takt
