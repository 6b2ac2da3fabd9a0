#include "eds_parser/report/report.hpp"

#include <algorithm>

namespace takt {

bool Report::wants(std::string_view rule) const noexcept {
  const auto it = std::ranges::find(counts_, rule, &Count::rule);
  return it == counts_.end() || it->declared < limit_per_rule;
}

void Report::note(SourcePos pos, std::string_view rule, std::string message) {
  add(pos, Severity::note, rule, std::move(message));
}

void Report::warning(SourcePos pos, std::string_view rule, std::string message) {
  add(pos, Severity::warning, rule, std::move(message));
}

void Report::error(SourcePos pos, std::string_view rule, std::string message) {
  add(pos, Severity::error, rule, std::move(message));
}

Findings Report::take() {
  std::ranges::stable_sort(findings_, {}, &Finding::pos);
  counts_.clear();
  return std::move(findings_);
}

void Report::add(SourcePos pos, Severity severity, std::string_view rule, std::string message) {
  auto it = std::ranges::find(counts_, rule, &Count::rule);
  if (it == counts_.end()) it = counts_.insert(counts_.end(), Count{rule});
  if (it->declared >= limit_per_rule) return;
  if (++it->declared == limit_per_rule) message += " (further findings of this rule are left out)";
  findings_.push_back({file_, pos, severity, rule, std::move(message)});
}

}  // namespace takt
