#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>

#include "eds_parser/cob_ids.hpp"
#include "eds_parser/network_spec.hpp"

namespace takt {

/// COB-IDs that services of the network use, each with a word for messages: "is TIME".
using ServiceIds = std::map<CobId, std::string>;

/// SYNC, TIME, EMCY and the SDO channels of the nodes; two users of one identifier are reported.
/// What CiA 301 reserves for all networks (is_restricted()) is not listed.
ServiceIds service_ids(const NetworkSpec& spec, std::span<const NodePdos> nodes,
                       NetworkReport& report);

/// EMCY of a node: of the network file, else of the device file; none: the predefined 0x080 + id.
std::optional<CobId> emcy_cob_id(const NodeSource& node);

}  // namespace takt
