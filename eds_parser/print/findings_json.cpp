#include "eds_parser/print/findings_json.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "eds_parser/print/json.hpp"

namespace takt {

void print_findings_json(std::ostream& out, std::span<const JudgedFile> files) {
  Json json{{"files", Json::array()}};
  const auto count = [&](Severity severity) {
    std::ptrdiff_t found = 0;
    for (const JudgedFile& file : files) {
      found += std::ranges::count(file.findings, severity, &Finding::severity);
    }
    return found;
  };
  for (const JudgedFile& file : files) {
    auto findings = Json::array();
    for (const Finding& finding : file.findings) findings.push_back(json_of(finding));
    json["files"].push_back(
        {{"file", file.file}, {"readable", file.readable}, {"findings", std::move(findings)}});
  }
  json["errors"] = count(Severity::error);
  json["warnings"] = count(Severity::warning);
  json["notes"] = count(Severity::note);
  print_document(out, json);
}

}  // namespace takt
