#include "eds_parser/print/findings_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

namespace takt {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Finding& finding) {
  return {{"line", finding.pos.line},
          {"column", finding.pos.column},
          {"severity", name(finding.severity)},
          {"rule", finding.rule},
          {"message", finding.message}};
}

}  // namespace

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
  out << json.dump(2, ' ', true, Json::error_handler_t::replace) << '\n';
}

}  // namespace takt
