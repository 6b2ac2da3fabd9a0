#pragma once
#include <span>
#include <vector>

#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/report/network_report.hpp"

namespace takt {

// Rules for the PDOs of one node as a set.

/// Reports each PDO of the network file that the device does not have.
void report_missing_pdos(const NodeSource& node, bool is_tpdo,
                         const std::vector<PdoDescription>& devices, NetworkReport& report);
/// Checks that the TPDO that answers an RPDO on request exists.
void check_request_pairs(const NodeSource& node, std::span<const EffectivePdo> pdos,
                         NetworkReport& report);

}  // namespace takt
