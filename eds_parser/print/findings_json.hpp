#pragma once
#include <iosfwd>
#include <ostream>
#include <span>
#include <string>

#include "eds_parser/report/source.hpp"

namespace takt {

/// One checked file with its findings.
struct JudgedFile {
  std::string file;
  bool readable = false;
  Findings findings;
};

/// Prints {"files": [{"file", "readable", "findings": [{"line", "column", "severity", "rule",
/// "message"}]}], "errors", "warnings", "notes"}.
void print_findings_json(std::ostream& out, std::span<const JudgedFile> files);

}  // namespace takt
