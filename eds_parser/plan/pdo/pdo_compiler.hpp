#pragma once
#include <vector>

#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/report/network_report.hpp"

namespace takt {

/// Compiles the PDOs of one node: first the RPDOs, then the TPDOs, each in ascending number.
/// COB-IDs that depend on the whole network are left to assign_cob_ids().
std::vector<EffectivePdo> compile_pdos(const NodeSource& node, NetworkReport& report);

}  // namespace takt
