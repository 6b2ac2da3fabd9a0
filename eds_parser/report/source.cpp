#include "eds_parser/report/source.hpp"

#include <algorithm>

#include "eds_parser/values/name_of.hpp"

namespace takt {

std::string_view name(Severity severity) noexcept {
  static constexpr std::string_view names[]{"note", "warning", "error"};
  return name_of(severity, names, "error");
}

std::string to_string(const Finding& finding) {
  std::string text = finding.file;
  if (finding.pos.line != 0) {
    text += ':' + std::to_string(finding.pos.line) + ':' + std::to_string(finding.pos.column);
  }
  text += ": ";
  text += name(finding.severity);
  text += ": " + finding.message + " [";
  text += finding.rule;
  text += ']';
  // Names in a file may contain any character. Line breaks are kept, because a message may have
  // several lines.
  std::ranges::replace_if(
      text, [](char c) { return (c >= 0 && c < 0x20 && c != '\n') || c == 0x7F; }, '?');
  return text;
}

bool has_error(const Findings& findings) noexcept {
  return std::ranges::any_of(
      findings, [](const Finding& finding) { return finding.severity == Severity::error; });
}

}  // namespace takt
