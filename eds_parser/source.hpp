#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// A place in a text file; line and column count from 1, 0 = the file as a whole.
struct SourcePos {
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  constexpr auto operator<=>(const SourcePos&) const noexcept = default;
};

enum class Severity : std::uint8_t {
  note,     ///< style
  warning,  ///< a deviation that can be read in only one way
  error,    ///< the device would refuse it, or takt would do something else than the author meant
};

/// One thing to tell about a file.
struct Finding {
  std::string file;
  SourcePos pos;
  Severity severity = Severity::warning;
  std::string_view rule;  ///< stable name, "unknown-key"; a string literal
  std::string message;    ///< what is wrong, what was assumed, what would be right
};

using Findings = std::vector<Finding>;

std::string_view name(Severity severity) noexcept;
/// `file:line:column: severity: message [rule]`.
std::string to_string(const Finding& finding);
bool has_error(const Findings& findings) noexcept;

}  // namespace takt
