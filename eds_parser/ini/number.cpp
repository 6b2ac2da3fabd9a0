#include "eds_parser/ini/number.hpp"

#include <charconv>
#include <cmath>
#include <limits>

#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

using Parsed = std::expected<ParsedNumber, NumberFault>;

/// The result of reading digits. `bad` means another character; `too_big` means more than 64 bits.
enum class Digits : std::uint8_t { good, bad, too_big };

Digits read_digits(std::string_view digits, int base, std::uint64_t& out) noexcept {
  if (digits.empty()) return Digits::bad;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), out, base);
  if (end != digits.data() + digits.size()) return Digits::bad;
  return error == std::errc::result_out_of_range ? Digits::too_big : Digits::good;
}

bool all_of(std::string_view text, std::string_view set) noexcept {
  return text.find_first_not_of(set) == std::string_view::npos;
}

/// Reads `5.0` as an integer if the value is one.
std::optional<ParsedNumber> integral_real(std::string_view text) noexcept {
  if (text.find('.') == std::string_view::npos) return std::nullopt;
  const auto real = parse_real(text);
  if (!real || !std::isfinite(*real) || std::trunc(*real) != *real) return std::nullopt;
  if (std::abs(*real) > 9007199254740992.0) return std::nullopt;
  ParsedNumber number;
  number.magnitude = static_cast<std::uint64_t>(std::abs(*real));
  number.negative = *real < 0;
  number.quirks = quirk_bit(NumberQuirk::fraction);
  return number;
}

/// Reads numbers other than 0x... and plain decimal digits: suffixes, hexadecimal without prefix,
/// reals.
Parsed read_unusual(std::string_view text) noexcept {
  if (const auto real = integral_real(text)) return *real;
  const auto last_digit = text.find_last_not_of("uUlL");
  if (last_digit != std::string_view::npos && last_digit + 1 < text.size()) {
    auto number = parse_number(text.substr(0, last_digit + 1));
    if (number) number->quirks |= quirk_bit(NumberQuirk::suffix);
    if (number) return number;
  }
  ParsedNumber number;
  // A name in hexadecimal digits (`DEAD`) is no number. `1E3` could be 1000 or 0x1E3, and `0b101`
  // could be 5 or 0xB101.
  const bool has_digit = text.find_first_of("0123456789") != std::string_view::npos;
  const bool real = all_of(text, "0123456789eE") && parse_real(text);
  const bool binary = text.size() > 2 && has_prefix(text, "0b") && all_of(text.substr(2), "01");
  const bool clear = has_digit && !real && !binary;
  if (clear && read_digits(text, 16, number.magnitude) == Digits::good) {
    number.hex = true;
    number.quirks = quirk_bit(NumberQuirk::hex_without_prefix);
    return number;
  }
  return std::unexpected{NumberFault::not_a_number};
}

Parsed finish(Digits digits, const ParsedNumber& number) noexcept {
  if (digits == Digits::good) return number;
  return std::unexpected{digits == Digits::too_big ? NumberFault::too_big
                                                   : NumberFault::not_a_number};
}

Parsed read_hex(std::string_view text) noexcept {
  ParsedNumber number;
  number.hex = true;
  auto digits = read_digits(text.substr(2), 16, number.magnitude);
  if (digits != Digits::bad) return finish(digits, number);
  const auto last = text.find_last_not_of("uUlL");
  if (last == std::string_view::npos || last + 1 == text.size() || last < 2) {
    return std::unexpected{NumberFault::not_a_number};
  }
  number.quirks = quirk_bit(NumberQuirk::suffix);
  digits = read_digits(text.substr(2, last - 1), 16, number.magnitude);
  return finish(digits, number);
}

/// Reads one term without a sign.
Parsed read_unsigned(std::string_view text) noexcept {
  if (text.empty()) return std::unexpected{NumberFault::not_a_number};
  if (is_prefixed_hex(text)) return read_hex(text);
  if (!all_of(text, "0123456789")) return read_unusual(text);
  ParsedNumber number;
  const bool zero_first = text.size() > 1 && text[0] == '0';
  const bool is_octal = zero_first && all_of(text, "01234567");
  const auto digits = read_digits(text, is_octal ? 8 : 10, number.magnitude);
  // "00" and "007" have the same value in octal and in decimal.
  if (is_octal && number.magnitude > 7) number.quirks = quirk_bit(NumberQuirk::octal);
  if (zero_first && !is_octal) number.quirks = quirk_bit(NumberQuirk::decimal_zero);
  return finish(digits, number);
}

/// Returns true for `$NODEID-1`, but not for `$NODEID_2`: the name is known, and only what follows
/// it is wrong.
bool starts_with_node_id(std::string_view text) noexcept {
  constexpr std::string_view name = "$nodeid";
  if (!has_prefix(text, name)) return false;
  const char next = text.size() > name.size() ? fold(text[name.size()]) : ' ';
  return next != '_' && (next < '0' || next > '9') && (next < 'a' || next > 'z');
}

Parsed read_term(std::string_view text) noexcept {
  const bool dollar = text.starts_with('$');
  if (same_word(dollar ? text.substr(1) : text, "nodeid")) {
    ParsedNumber number;
    number.node_ids = 1;
    if (!dollar) number.quirks = quirk_bit(NumberQuirk::node_id_no_dollar);
    return number;
  }
  if (dollar) {
    return std::unexpected{starts_with_node_id(text) ? NumberFault::not_a_number
                                                     : NumberFault::unknown_name};
  }
  const bool minus = text.starts_with('-');
  auto number = read_unsigned(minus ? trim(text.substr(1)) : text);
  if (number && minus) number->negative = !number->negative && number->magnitude != 0;
  return number;
}

/// Computes sum += term. In practice all terms have the same sign.
bool add(ParsedNumber& sum, const ParsedNumber& term) noexcept {
  if (sum.node_ids + term.node_ids > 127) return false;
  sum.node_ids = static_cast<std::uint8_t>(sum.node_ids + term.node_ids);
  sum.quirks |= term.quirks;
  sum.hex = sum.hex || term.hex;
  if (sum.negative == term.negative || sum.magnitude == 0 || term.magnitude == 0) {
    if (term.magnitude > std::numeric_limits<std::uint64_t>::max() - sum.magnitude) return false;
    sum.negative = sum.negative || term.negative;
    sum.magnitude += term.magnitude;
    return true;
  }
  const bool keep_sign = sum.magnitude >= term.magnitude;
  sum.magnitude = keep_sign ? sum.magnitude - term.magnitude : term.magnitude - sum.magnitude;
  sum.negative = sum.magnitude != 0 && (keep_sign ? sum.negative : term.negative);
  return true;
}

/// Returns the position of the `+` that ends a term. The `+` of an exponent (`1e+3`) does not end
/// it.
std::size_t end_of_term(std::string_view text) noexcept {
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] != '+') continue;
    const bool exponent = fold(text[i - 1]) == 'e' && i >= 2 && text[i - 2] >= '0' &&
                          text[i - 2] <= '9' && text.find_first_of("xX") == std::string_view::npos;
    if (!exponent) return i;
  }
  return std::string_view::npos;
}

/// Reads the decimal and 0x forms that nearly all numbers have. Returns std::nullopt for any other
/// form.
std::optional<ParsedNumber> plain_number(std::string_view text) noexcept {
  ParsedNumber number;
  const bool minus = text.starts_with('-');
  if (minus) text.remove_prefix(1);
  if (is_prefixed_hex(text)) {
    if (text.size() > 2 + 16) return std::nullopt;
    number.hex = true;
    for (const char c : text.substr(2)) {
      const int digit = hex_digit(c);
      if (digit < 0) return std::nullopt;
      number.magnitude = number.magnitude << 4 | static_cast<unsigned>(digit);
    }
    number.negative = minus && number.magnitude != 0;
    return number;
  }
  const bool leading_zero = text.size() > 1 && text.front() == '0';
  if (text.empty() || text.size() > 19 || leading_zero) return std::nullopt;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    number.magnitude = number.magnitude * 10 + static_cast<unsigned>(c - '0');
  }
  number.negative = minus && number.magnitude != 0;
  return number;
}

Parsed read_sum(std::string_view text) noexcept {
  if (text.front() == '+') text = trim(text.substr(1));
  ParsedNumber sum;
  bool first = true;
  for (;;) {
    const auto plus = text.empty() ? std::string_view::npos : end_of_term(text);
    const auto term = read_term(trim(text.substr(0, plus)));
    if (!term) return term;
    if (!first && term->node_ids > 0 && sum.node_ids == 0) {
      sum.quirks |= quirk_bit(NumberQuirk::node_id_not_first);
    }
    if (!add(sum, *term)) return std::unexpected{NumberFault::too_big};
    if (plus == std::string_view::npos) return sum;
    text = trim(text.substr(plus + 1));
    first = false;
  }
}

}  // namespace

std::expected<ParsedNumber, NumberFault> parse_number(std::string_view text) noexcept {
  if (const auto plain = plain_number(text)) return *plain;
  const auto bare = without_comment(trim(text));
  if (bare.empty()) return std::unexpected{NumberFault::empty};
  auto number = read_sum(bare);
  if (number && bare.size() != trim(text).size()) number->quirks |= quirk_bit(NumberQuirk::comment);
  return number;
}

std::optional<double> parse_real(std::string_view text) noexcept {
  auto bare = without_comment(trim(text));
  if (bare.starts_with('+')) bare.remove_prefix(1);
  if (bare.empty()) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(bare.data(), bare.data() + bare.size(), value);
  const auto rest = bare.substr(static_cast<std::size_t>(end - bare.data()));
  if (error != std::errc{} || !(rest.empty() || same_word(rest, "f"))) return std::nullopt;
  return value;
}

std::optional<bool> boolean_word(std::string_view text) noexcept {
  const auto is_word = [text](std::string_view word) { return same_word(text, word); };
  if (is_word("true") || is_word("yes") || is_word("on")) return true;
  if (is_word("false") || is_word("no") || is_word("off")) return false;
  return std::nullopt;
}

}  // namespace takt
