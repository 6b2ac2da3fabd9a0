#pragma once
#include <optional>
#include <string>

#include "eds_parser/network_report.hpp"
#include "eds_parser/network_spec.hpp"

namespace takt {

/// A numeric `cob_id` of the network file.
struct FileCobId {
  bool off = false;         ///< bit 31
  std::optional<CobId> id;  ///< none: off, or no identifier (reported)
};

/// Takes `cob_id` of `spec`, a number, apart and says what its bits 29..31 mean: the file has them
/// as 0x1800:01 does, but not each can be had. CiA 301, 7.5.2.35. `owner` names the PDO in
/// findings.
FileCobId read_cob_id_bits(const PdoSpec& spec, bool is_tpdo, const std::string& owner,
                           NetworkReport& report);

}  // namespace takt
