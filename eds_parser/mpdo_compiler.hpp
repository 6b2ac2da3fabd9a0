#pragma once
#include <vector>

#include "eds_parser/effective_pdo.hpp"
#include "eds_parser/network_report.hpp"

namespace takt {

/// The objects of a multiplexed PDO, as the network file lists them: of the device's dictionary for
/// SAM and for what the master sends, of the master's own (`bits` says how wide) for a DAM of the
/// device.
std::vector<EffectiveEntry> compile_mpdo(const NodeSource& node, const EffectivePdo& pdo,
                                         const Sourced<std::vector<MappingSpec>>& wanted,
                                         NetworkReport& report);

/// Bytes 0..3 of the frames that carry this object. What the master sends by source address has the
/// name under which the device's dispatching list awaits it. CiA 301, 7.2.3.
std::uint32_t mpdo_header(const NodeSource& node, const EffectivePdo& pdo,
                          const EffectiveEntry& entry, NodeId master);

/// What the master sends by source address has to be in the device's dispatching list.
void check_dispatching(const NodeSource& node, const EffectivePdo& pdo, NodeId master,
                       NetworkReport& report);

}  // namespace takt
