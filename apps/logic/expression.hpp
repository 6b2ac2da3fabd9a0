#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace takt {

/// An operation of an expression. A value is true if it is not 0; results are 0 or 1.
enum class Operation : std::uint8_t {
  negate,  ///< operator `not`
  both,    ///< operator `and`
  either,  ///< operator `or`
  equal,
  unequal,
  less,
  at_most,
  greater,
  at_least,
  rising,   ///< 1 for the one image in which the operand becomes true
  falling,  ///< 1 for the one image in which the operand becomes false
};

/// A name in an expression: "io.read_input_8_bit", its bit 3 "io.read_input_8_bit.3", a state of a
/// drive "shoulder.fault", or the marker "armed".
struct NameUse {
  std::string name;
  std::size_t column = 0;  ///< column of the first character in the text, counted from 0
};

/// One step: a number, a name or an operation.
using Step = std::variant<double, NameUse, Operation>;

/// An expression in postfix notation: operands come before their operation. Each evaluation runs
/// all steps, so that no edge is missed.
struct Expression {
  static constexpr std::size_t most_text = 2000;  ///< characters
  static constexpr int most_depth = 50;           ///< parentheses and `not` inside each other

  std::vector<Step> steps;
};

/// The reason why a text is no expression, and the place of the fault.
struct ExpressionFault {
  std::string text;
  std::size_t column = 0;  ///< counts from 0
};

/// Reads an expression. The operators from the lowest to the highest precedence are `or`, `and`,
/// `not` and comparisons (`== != < <= > >=`). The operands are numbers, names, `true`, `false`,
/// `rising(...)`, `falling(...)` and expressions in parentheses.
std::variant<Expression, ExpressionFault> parse_expression(std::string_view text);

/// Returns true if the text is one or more words of letters, digits and _ with points between.
bool is_name(std::string_view text) noexcept;

}  // namespace takt
