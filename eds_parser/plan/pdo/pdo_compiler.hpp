#pragma once
#include <vector>

#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/report/network_report.hpp"

namespace takt {

/// Compiles the PDOs of one node: first the RPDOs, then the TPDOs, each in ascending number.
/// COB-IDs that depend on the whole network are left to assign_cob_ids().
std::vector<EffectivePdo> compile_pdos(const NodeSource& node, NetworkReport& report);

/// Returns a copy of the dictionary with the values that `sdo:` writes into PDO parameters
/// (0x1400..0x1BFF). The PDOs are then compiled as the device will have them.
ObjectDictionary with_pdo_writes(const ObjectDictionary& dictionary, const NodeSpec& spec);

}  // namespace takt
