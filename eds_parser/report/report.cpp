#include "eds_parser/report/report.hpp"

#include <algorithm>
#include <utility>

namespace takt {

Findings Report::take() {
  std::ranges::stable_sort(findings_, {}, &Finding::pos);
  counts_.clear();
  return std::move(findings_);
}

std::size_t Report::count(std::string_view rule) {
  auto it = std::ranges::find(counts_, rule, &Count::rule);
  if (it == counts_.end()) it = counts_.insert(counts_.end(), Count{rule});
  return it->findings < limit_per_rule ? ++it->findings : 0;
}

}  // namespace takt
