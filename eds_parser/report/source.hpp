#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// A place in a text file. Line and column count from 1; 0 means the file as a whole.
struct SourcePos {
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  constexpr auto operator<=>(const SourcePos&) const noexcept = default;
};

enum class Severity : std::uint8_t {
  note,     ///< a matter of style, or information that requires no change
  warning,  ///< a deviation that can be read in only one way
  error,    ///< The device would refuse the value, or takt would not do what the author meant.
};

/// One statement about a file.
struct Finding {
  std::string file;
  SourcePos pos;
  Severity severity = Severity::warning;
  /// Stable name of the rule, such as "unknown-key"; must be a string literal.
  std::string_view rule;
  std::string message;  ///< the fault, the assumption that was made, and the correct form
};

using Findings = std::vector<Finding>;

std::string_view name(Severity severity) noexcept;
/// Returns the finding as `file:line:column: severity: message [rule]`.
std::string to_string(const Finding& finding);
bool has_error(const Findings& findings) noexcept;

}  // namespace takt
