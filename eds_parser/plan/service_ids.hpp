#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>

#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/specification/network_spec.hpp"

namespace takt {

/// COB-IDs that services of the network use, each with a phrase for messages: "is TIME".
using ServiceIds = std::map<CobId, std::string>;

/// Returns the COB-IDs of SYNC, TIME, EMCY and the SDO channels of the nodes. Two users of one
/// identifier are reported. Identifiers that CiA 301 reserves in all networks (is_restricted()) are
/// not listed.
ServiceIds service_ids(const NetworkSpec& spec, std::span<const NodePdos> nodes,
                       NetworkReport& report);

/// Returns the EMCY identifier of a node from the network file, else from the device file. Returns
/// std::nullopt for the predefined 0x080 + node-ID, and if EMCY is off.
std::optional<CobId> emcy_cob_id(const NodeSource& node);

}  // namespace takt
