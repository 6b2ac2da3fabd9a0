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

/// Prints the errors and warnings of a network file that a tool has written, if taktd does not
/// accept it. Returns the exit code.
inline int judge_written(const std::string& file, const Findings& findings) {
  if (!has_error(findings)) return 0;
  print_findings(findings, Severity::warning);
  std::cerr << file
            << ": this file was written, but taktd does not accept it; correct the errors above\n";
  return 1;
}

}  // namespace takt
