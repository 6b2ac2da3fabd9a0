#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/logic/expression.hpp"
#include "eds_parser/report/source.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// An expression of the file, with its text and its place.
struct WrittenExpression {
  std::string text;
  SourcePos pos;
  Expression expression;

  /// Returns the place of a name in this expression.
  SourcePos pos_of(const NameUse& use) const;
};

/// What a rule does with its target.
enum class RuleKind : std::uint8_t {
  set,    ///< the target is on while `first` is true, after the delays
  latch,  ///< `first` sets the target, `second` resets it and has priority
  count,  ///< the target counts how often `first` has become true; `second` resets it
};

/// One rule of the file. A target whose name has a point is an output, or one bit of it. Any other
/// target is a marker, which only rules see.
struct Rule {
  RuleKind kind = RuleKind::set;
  std::string target;
  SourcePos pos;  ///< place of the target
  WrittenExpression first;
  std::optional<WrittenExpression> second;
  Time on_delay{0};
  Time off_delay{0};
  double on_value = 1.0;  ///< value of the target while the target is on, in the unit of the output
  double off_value = 0.0;  ///< value of the target while the target is off
};

/// Largest number of rules in a file.
constexpr std::size_t most_rules = 1000;

/// Reads the rules. Appends what is wrong to `findings`; the rules are usable only if there is no
/// error.
std::vector<Rule> read_rules(std::string_view text, const std::string& file, Findings& findings);

/// Returns the rule as one line for people.
std::string rule_text(const Rule& rule);

}  // namespace takt
