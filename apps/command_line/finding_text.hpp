#pragma once
#include <iostream>
#include <string>

#include "eds_parser/report/report.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {

/// Returns a finding as one line for a terminal. Findings quote files that may come from anywhere,
/// so unprintable characters become '?'.
inline std::string finding_text(const Finding& finding) {
  return printable_text(to_string(finding));
}

/// Prints the findings of at least this severity on stderr. Returns true if any finding is an
/// error, even one that is not printed.
inline bool print_findings(const Findings& findings, Severity least = Severity::note) {
  for (const Finding& finding : findings) {
    if (finding.severity >= least) std::cerr << finding_text(finding) << '\n';
  }
  return has_error(findings);
}

}  // namespace takt
