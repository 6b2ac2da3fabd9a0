#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "eds_parser/effective_pdo.hpp"
#include "eds_parser/network_report.hpp"

namespace takt {

/// The PDOs of one node while the network is compiled.
struct NodePdos {
  NodeSource node;
  std::vector<EffectivePdo> pdos;
};

/// Never for a PDO. CiA 301, 7.3.5, table 40.
bool is_restricted(std::uint32_t id) noexcept;

/// Gives every exchanged PDO its COB-ID and reports clashes. Ids of the network file stand; ids of
/// device files that work are never moved; absolute ids of device files that clash become
/// node-relative, with a note, unless they are a link: an RPDO with the id of another device's TPDO
/// is fed by it. `auto`: the predefined set for PDO 1..4, above that the lowest free id in
/// 0x181..0x57F. `services`: identifiers that no PDO may have, with a word each ("is TIME").
void assign_cob_ids(std::span<NodePdos> nodes, const std::map<CobId, std::string>& services,
                    NetworkReport& report);

}  // namespace takt
