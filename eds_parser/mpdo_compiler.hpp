#pragma once
#include <vector>

#include "eds_parser/effective_pdo.hpp"
#include "eds_parser/network_report.hpp"

namespace takt {

/// The objects of a multiplexed PDO, as the network file lists them: of the device's dictionary for
/// SAM and for the master's DAM, of the master's own (`bits` says how wide) for a DAM of the
/// device.
std::vector<EffectiveEntry> compile_mpdo(const NodeSource& node, const EffectivePdo& pdo,
                                         const Sourced<std::vector<MappingSpec>>& wanted,
                                         NetworkReport& report);

/// Bytes 0..3 of the frames that carry this object. CiA 301, 7.2.3.
std::uint32_t mpdo_header(const EffectivePdo& pdo, const EffectiveEntry& entry, NodeId device,
                          NodeId master) noexcept;

}  // namespace takt
