#pragma once
#include <string>

#include "eds_parser/report/report.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {

/// Returns a finding as one line for a terminal. Findings quote files that may come from anywhere,
/// so unprintable characters become '?'.
inline std::string finding_text(const Finding& finding) {
  return printable_text(to_string(finding));
}

}  // namespace takt
