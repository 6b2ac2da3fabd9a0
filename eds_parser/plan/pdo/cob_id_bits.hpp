#pragma once
#include <optional>
#include <string>

#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/network_spec.hpp"

namespace takt {

/// A numeric `cob_id` of the network file.
struct FileCobId {
  bool off = false;         ///< bit 31: the PDO is switched off
  std::optional<CobId> id;  ///< empty if `off`, or if the number is no identifier (reported)
};

/// Splits the numeric `cob_id` of `spec` and reports the effect of its bits 29..31. The bits have
/// the same meaning as in 0x1800:01, but takt can not fulfil each of them. CiA 301, 7.5.2.35.
/// `owner` names the PDO in findings.
FileCobId read_cob_id_bits(const PdoSpec& spec, bool is_tpdo, const std::string& owner,
                           NetworkReport& report);

}  // namespace takt
