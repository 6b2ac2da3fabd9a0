#pragma once
#include <string>
#include <vector>

#include "eds_parser/source.hpp"

namespace takt {

/// TPDOs that are on in their devices and may be sent, though the master does not exchange them:
/// the plan does not know them, the budget does not count them. A sentence each.
std::vector<std::string> left_out_tpdos(const Findings& findings);

}  // namespace takt
