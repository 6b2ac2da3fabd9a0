#pragma once
#include <vector>

#include "eds_parser/effective_pdo.hpp"
#include "eds_parser/network_report.hpp"

namespace takt {

/// The PDOs of one node: RPDOs, then TPDOs, each in ascending number. COB-IDs that follow from the
/// whole network are left to assign_cob_ids().
std::vector<EffectivePdo> compile_pdos(const NodeSource& node, NetworkReport& report);

/// Overlays the dictionary with what `sdo:` writes into PDO parameters (0x1400..0x1BFF), so that
/// the PDOs are compiled as the device will have them.
ObjectDictionary with_pdo_writes(const ObjectDictionary& dictionary, const NodeSpec& spec);
/// An object of the PDO parameter records.
constexpr bool is_pdo_parameter(std::uint16_t index) noexcept {
  return index >= 0x1400 && index <= 0x1BFF;
}

}  // namespace takt
