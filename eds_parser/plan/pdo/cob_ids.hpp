#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/report/network_report.hpp"

namespace takt {

/// The PDOs of one node during the compilation of the network.
struct NodePdos {
  NodeSource node;
  std::vector<EffectivePdo> pdos;
};

/// Returns true if no PDO may have this CAN-ID. CiA 301, 7.3.5, table 40.
bool is_restricted(std::uint32_t id) noexcept;

/// Gives every exchanged PDO its COB-ID and reports clashes. A COB-ID of the network file is never
/// changed, nor is a COB-ID of a device file that causes no clash. An absolute COB-ID of a device
/// file that clashes becomes node-relative, with a note. The exception is a link: an RPDO with the
/// COB-ID of another device's TPDO receives that TPDO. `auto` gives PDO 1..4 the predefined
/// connection set, and other PDOs the lowest free identifier in 0x181..0x57F. It is an error if the
/// network file gives the predefined COB-ID of an `auto` TPDO to another TPDO. `services` holds
/// identifiers that no PDO may have, each with a phrase for messages ("is TIME").
void assign_cob_ids(std::span<NodePdos> nodes, const std::map<CobId, std::string>& services,
                    NetworkReport& report);

}  // namespace takt
