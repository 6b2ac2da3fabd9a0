#pragma once
#include <string>
#include <vector>

#include "eds_parser/report/source.hpp"

namespace takt {

/// Returns one sentence for each TPDO that is enabled in its device but that the master does not
/// exchange. The device may send it, but the plan does not contain it and the budget does not count
/// it.
std::vector<std::string> left_out_tpdos(const Findings& findings);

}  // namespace takt
