#include "apps/logic/expression.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace takt {
namespace {

struct Comparison {
  std::string_view sign;
  Operation operation;
};
/// The parser takes the first sign that fits, so `<=` comes before `<`.
constexpr std::array<Comparison, 6> comparisons{{{"==", Operation::equal},
                                                 {"!=", Operation::unequal},
                                                 {"<=", Operation::at_most},
                                                 {">=", Operation::at_least},
                                                 {"<", Operation::less},
                                                 {">", Operation::greater}}};

bool is_letter(char c) noexcept {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

class Parser {
 public:
  explicit Parser(std::string_view text) : text_{text} {}

  std::variant<Expression, ExpressionFault> parse() {
    if (text_.size() > Expression::most_text) {
      return ExpressionFault{.text = "the expression is longer than 2000 characters"};
    }
    if (either() && (skip(), at_ < text_.size())) expected("`and`, `or` or the end");
    if (fault_) return std::move(*fault_);
    return std::move(expression_);
  }

 private:
  bool either() {
    if (!both()) return false;
    while (take_word("or")) {
      if (!both()) return false;
      expression_.steps.emplace_back(Operation::either);
    }
    return true;
  }

  bool both() {
    if (!inverse()) return false;
    while (take_word("and")) {
      if (!inverse()) return false;
      expression_.steps.emplace_back(Operation::both);
    }
    return true;
  }

  bool inverse() {
    if (!take_word("not")) return comparison();
    if (!enter() || !inverse()) return false;
    --depth_;
    expression_.steps.emplace_back(Operation::negate);
    return true;
  }

  bool comparison() {
    if (!operand()) return false;
    skip();
    for (const auto& [sign, operation] : comparisons) {
      if (!text_.substr(at_).starts_with(sign)) continue;
      at_ += sign.size();
      if (!operand()) return false;
      expression_.steps.emplace_back(operation);
      break;
    }
    return true;
  }

  bool operand() {
    skip();
    const std::size_t begin = at_;
    if (take_sign('(')) return inside();
    if (take_word("rising")) return edge(Operation::rising);
    if (take_word("falling")) return edge(Operation::falling);
    const std::string_view word = text_.substr(begin, word_length());
    if (word.empty()) return expected("a name, a number, `not` or `(`");
    at_ += word.size();
    if (word == "and" || word == "or" || word == "not") {
      at_ = begin;
      return expected("a name or a number");
    }
    if (word == "true" || word == "false") {
      expression_.steps.emplace_back(word == "true" ? 1.0 : 0.0);
    } else if (const auto value = number(word)) {
      expression_.steps.emplace_back(*value);
    } else if (is_name(word) && std::isdigit(static_cast<unsigned char>(word.front())) == 0) {
      expression_.steps.emplace_back(NameUse{.name = std::string{word}, .column = begin});
    } else {
      at_ = begin;
      return expected("a name or a number, such as io.read_input.3, armed, 12 or 0x1F");
    }
    return true;
  }

  bool edge(Operation operation) {
    skip();
    if (!take_sign('(')) return expected("`(`");
    if (!inside()) return false;
    expression_.steps.emplace_back(operation);
    return true;
  }

  /// Reads the expression between parentheses, and the closing parenthesis.
  bool inside() {
    if (!enter() || !either()) return false;
    --depth_;
    skip();
    return take_sign(')') || expected("`)`, `and` or `or`");
  }

  bool enter() {
    return ++depth_ <= Expression::most_depth || fail("the expression is nested too deep");
  }

  static std::optional<double> number(std::string_view word) {
    const char* end = word.data() + word.size();
    if (word.starts_with("0x") || word.starts_with("0X")) {
      std::uint64_t value = 0;
      const auto read = std::from_chars(word.data() + 2, end, value, 16);
      const bool good = read.ec == std::errc{} && read.ptr == end;
      return good ? std::optional{static_cast<double>(value)} : std::nullopt;
    }
    double value = 0.0;
    const auto read = std::from_chars(word.data(), end, value);
    const bool good = read.ec == std::errc{} && read.ptr == end && std::isfinite(value);
    return good ? std::optional{value} : std::nullopt;
  }

  /// Returns the length of the next word. A word may begin with `-`, as a number does.
  std::size_t word_length() const {
    std::size_t end = at_;
    if (end < text_.size() && text_[end] == '-') ++end;
    while (end < text_.size() && (is_letter(text_[end]) || text_[end] == '.')) ++end;
    return end - at_;
  }

  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }
  bool take_word(std::string_view word) {
    skip();
    if (text_.substr(at_, word_length()) != word) return false;
    at_ += word.size();
    return true;
  }
  bool take_sign(char sign) {
    if (at_ >= text_.size() || text_[at_] != sign) return false;
    ++at_;
    return true;
  }
  bool expected(const std::string& what) {
    const std::size_t length = std::max<std::size_t>(word_length(), 1);
    const std::string found = at_ < text_.size()
                                  ? "`" + std::string{text_.substr(at_, length)} + "`"
                                  : std::string{"the expression ends"};
    return fail(found + " where " + what + " is expected");
  }
  bool fail(std::string why) {
    if (!fault_) fault_ = ExpressionFault{.text = std::move(why), .column = at_};
    return false;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  Expression expression_;
  std::optional<ExpressionFault> fault_;
};

}  // namespace

std::variant<Expression, ExpressionFault> parse_expression(std::string_view text) {
  return Parser{text}.parse();
}

bool is_name(std::string_view text) noexcept {
  bool after_point = true;
  for (const char c : text) {
    if (!is_letter(c) && (c != '.' || after_point)) return false;
    after_point = c == '.';
  }
  return !after_point;
}

}  // namespace takt
