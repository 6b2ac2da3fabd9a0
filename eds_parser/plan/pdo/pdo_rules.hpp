#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eds_parser/dictionary/pdo_description.hpp"
#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/network_spec.hpp"

namespace takt {

// Rules for the PDOs of the network file.

/// A numeric `cob_id` of the network file.
struct FileCobId {
  bool off = false;         ///< bit 31: the PDO is switched off
  std::optional<CobId> id;  ///< empty if `off`, or if the number is no identifier (reported)
};

/// Splits the numeric `cob_id` of `spec` and reports the effect of its bits 29..31. The bits have
/// the same meaning as in 0x1800:01, but takt cannot fulfil all of them. CiA 301, 7.5.2.35. `owner`
/// names the PDO in findings.
FileCobId read_cob_id_bits(const PdoSpec& spec, bool is_tpdo, const std::string& owner,
                           NetworkReport& report);

// Rules for the PDOs of one node as a set.

/// Reports each PDO of the network file that the device does not have.
void report_missing_pdos(const NodeSource& node, bool is_tpdo,
                         const std::vector<PdoDescription>& devices, NetworkReport& report);
/// Checks that the TPDO that answers an RPDO on request exists.
void check_request_pairs(const NodeSource& node, std::span<const EffectivePdo> pdos,
                         NetworkReport& report);

}  // namespace takt
