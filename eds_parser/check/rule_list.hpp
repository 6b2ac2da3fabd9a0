#pragma once
#include <span>
#include <string_view>

#include "eds_parser/report/source.hpp"

namespace takt {

/// The description of a rule for people.
struct RuleInfo {
  std::string_view name;
  std::string_view meaning;
  std::string_view example;
  Severity severity = Severity::warning;  ///< usual severity
};

/// Returns all rules of the EDS reader and of check(), sorted by name.
std::span<const RuleInfo> eds_rules() noexcept;

}  // namespace takt
