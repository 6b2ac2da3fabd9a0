#pragma once
#include <span>
#include <string_view>

#include "eds_parser/source.hpp"

namespace takt {

/// What a rule is about, for people.
struct RuleInfo {
  std::string_view name;
  Severity severity;  ///< the usual one
  std::string_view meaning;
  std::string_view example;
};

/// All rules of the EDS reader and of check(), by name.
std::span<const RuleInfo> eds_rules() noexcept;

}  // namespace takt
