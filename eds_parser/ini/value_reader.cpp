#include "eds_parser/ini/value_reader.hpp"

#include <bit>
#include <cmath>

#include "eds_parser/ini/fitted_number.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

using Expected = std::expected<ParsedNumber, NumberFault>;

struct QuirkText {
  NumberQuirk quirk;
  std::string_view rule;
  std::string_view message;
};

constexpr QuirkText quirk_texts[] = {
    {NumberQuirk::octal, "octal-number",
     "leading zero: read as octal, as CiA 306 says; write 0x... or no leading zero"},
    {NumberQuirk::decimal_zero, "leading-zero",
     "leading zero would mean octal, but has an 8 or 9: read as decimal; drop the zero"},
    {NumberQuirk::suffix, "number-suffix",
     "suffix of a programming language was left out; remove the suffix"},
    {NumberQuirk::node_id_not_first, "nodeid-not-first",
     "CiA 306 requires $NODEID as the first term, other tools drop it here; write $NODEID+number"},
    {NumberQuirk::node_id_no_dollar, "nodeid-without-dollar",
     "NODEID was read as $NODEID; write $NODEID+number"},
    {NumberQuirk::hex_without_prefix, "hex-without-prefix",
     "read as hexadecimal; write 0x in front"},
    {NumberQuirk::fraction, "integer-with-fraction",
     "decimal point in an integer value; remove the decimal point"},
    {NumberQuirk::comment, "inline-comment",
     "text behind ';' or '#' was read as a comment; CiA 306 has no comments behind values"},
    {NumberQuirk::word, "boolean-word", "read as a boolean; write 0 or 1"},
};

/// Reports the quirks of a number. `place` is the key, or a ValuePlace.
template <class Place>
void report_quirks(Report& report, std::uint16_t quirks, std::string_view text, SourcePos pos,
                   const Place& place) {
  for (const auto& known : quirk_texts) {
    if ((quirks & quirk_bit(known.quirk)) == 0) continue;
    report.warning(pos, known.rule, place, ": ", Quoted{text}, ": ", known.message);
  }
}

/// Returns true for bit patterns of 0 and of normal numbers. 0xFFFF in a REAL32 would be 9.2e-41;
/// an author who means such a number writes all digits.
bool is_pattern(std::uint64_t bits, DataType type) noexcept {
  const unsigned fraction = type == DataType::real32 ? 23 : 52;
  return bits == 0 || bits >> fraction != 0;
}

double real_of(std::uint64_t bits, DataType type) noexcept {
  return type == DataType::real32 ? std::bit_cast<float>(static_cast<std::uint32_t>(bits))
                                  : std::bit_cast<double>(bits);
}

}  // namespace

std::string to_string(const ValuePlace& place) {
  return to_string(place.key) + ' ' + std::string{place.what};
}

std::optional<Value> ValueReader::read(std::string_view text, DataType type,
                                       const ValuePlace& place) {
  if (text.empty()) return std::nullopt;
  if (type == DataType::unknown) return read_untyped(text);
  if (type == DataType::visible_string) return std::string{text};
  if (type == DataType::unicode_string) return to_utf8(text);
  if (is_bytes(type)) return read_bytes(text, place);
  if (is_real(type)) return read_real(text, type, place);
  if (is_time(type)) return read_time(text, type, place);
  return read_integer(text, type, place);
}

std::optional<Value> ValueReader::read_integer(std::string_view text, DataType type,
                                               const ValuePlace& place) {
  auto number = parse_number(text);
  if (!number && type == DataType::boolean) {
    if (const auto word = boolean_word(without_comment(text))) {
      number = ParsedNumber{.magnitude = *word ? 1U : 0U, .quirks = quirk_bit(NumberQuirk::word)};
    }
  }
  if (!number) {
    if (number.error() == NumberFault::empty) return std::nullopt;
    if (number.error() == NumberFault::not_a_number) {
      unreadable(text, name(type), place);
    } else if (number.error() == NumberFault::too_big) {
      exceeds(text, type, place);
    } else {
      report_.error(place.pos, "value-unreadable", place, ": ", Quoted{text},
                    " contains a name other than $NODEID; the value is dropped");
    }
    return std::nullopt;
  }
  if (number->quirks != 0) report_quirks(report_, number->quirks, text, place.pos, place);
  if (number->relative() && !node_) return std::nullopt;
  if (!resolve(*number, node_)) {
    exceeds(text, type, place);
    return std::nullopt;
  }
  const unsigned bits = bit_width(type);
  auto fitted = is_signed(type) ? fit_signed(*number, bits) : fit_unsigned(*number, bits);
  if (!fitted.value) exceeds(text, type, place);
  if (fitted.wrapped) report_wrapped(text, type, *fitted.value, place);
  return fitted.value;
}

std::optional<Value> ValueReader::read_real(std::string_view text, DataType type,
                                            const ValuePlace& place) {
  const auto bare = without_reported_comment(text, place);
  if (is_prefixed_hex(bare)) {
    const auto pattern = parse_number(bare);
    const bool fits =
        pattern && !pattern->relative() && pattern->magnitude <= highest_unsigned(bit_width(type));
    if (!fits) {
      unreadable(text, name(type), place);
      return std::nullopt;
    }
    const bool all_digits = bare.size() - 2 >= bit_width(type) / 4;
    const bool as_bits = all_digits || is_pattern(pattern->magnitude, type);
    const double value =
        as_bits ? real_of(pattern->magnitude, type) : static_cast<double>(pattern->magnitude);
    report_.warning(place.pos, "real-bit-pattern", place, ": hexadecimal was read as ",
                    as_bits ? "the bit pattern of " : "", value, "; write a decimal number");
    return value;
  }
  if (bare.empty()) return std::nullopt;
  const auto value = parse_real(bare);
  if (!value) unreadable(text, name(type), place);
  if (!value) return std::nullopt;
  if (fold(bare.back()) == 'f' && std::isfinite(*value)) {
    report_quirks(report_, quirk_bit(NumberQuirk::suffix), text, place.pos, place);
  }
  if (type == DataType::real64 || !std::isfinite(*value)) return *value;
  const auto fitted = fit_real32(*value);
  if (!fitted) exceeds(text, type, place);
  return fitted;
}

std::optional<Value> ValueReader::read_bytes(std::string_view text, const ValuePlace& place) {
  auto digits = without_reported_comment(text, place);
  // Some tools write an empty value in this way.
  if (digits == "0" || digits == "0x0") return std::nullopt;
  bool odd_form = has_prefix(digits, "0x");
  if (odd_form) digits.remove_prefix(2);
  std::string bytes;
  bytes.reserve(digits.size() / 2);
  int high = -1;
  for (const char c : digits) {
    if (is_blank(c)) {
      odd_form = true;
      continue;
    }
    const int digit = hex_digit(c);
    if (digit < 0) {
      unreadable(text, "a row of hex byte pairs", place);
      return std::nullopt;
    }
    if (high >= 0) bytes += static_cast<char>(high << 4 | digit);
    high = high >= 0 ? -1 : digit;
  }
  if (high >= 0) {
    unreadable(text, "a row of hex byte pairs (one digit is left over)", place);
    return std::nullopt;
  }
  if (odd_form) {
    report_.warning(place.pos, "octet-string-form", place,
                    ": 0x and blanks were left out; write bare hex byte pairs");
  }
  return bytes;
}

/// Reads days and milliseconds since midnight as two numbers, or the 48 bits as one number. CiA 306
/// defines no form for times. Other tools write the days first, so this order applies if both
/// orders fit.
std::optional<Value> ValueReader::read_time(std::string_view text, DataType type,
                                            const ValuePlace& place) {
  const auto bare = without_comment(text);
  const auto gap = bare.find_first_of(" \t");
  if (gap == std::string_view::npos) return read_integer(text, type, place);
  without_reported_comment(text, place);
  const auto first = parse_number(bare.substr(0, gap));
  const auto second = parse_number(bare.substr(gap));
  const auto in_bits = [](const Expected& number, unsigned bits) {
    return number && number->is_within(highest_unsigned(bits));
  };
  if (in_bits(first, 16) && in_bits(second, 28)) return second->magnitude | first->magnitude << 32;
  if (in_bits(first, 28) && in_bits(second, 16)) return first->magnitude | second->magnitude << 32;
  unreadable(text, "days and milliseconds", place);
  return std::nullopt;
}

/// Reads a value of unknown type. An integer is kept, so that it can be displayed.
std::optional<Value> ValueReader::read_untyped(std::string_view text) {
  auto number = parse_number(text);
  if (!number || !resolve(*number, node_)) return std::nullopt;
  if (!number->negative) return number->magnitude;
  return fit_signed(*number, 64).value;
}

std::optional<std::uint32_t> ValueReader::read_count(const IniEntry& entry, std::uint32_t highest) {
  const auto number = parse_number(entry.value);
  if (!number && number.error() == NumberFault::empty) return std::nullopt;
  if (!number || !number->is_within(highest)) {
    report_.warning(entry.pos(), "number-unreadable", entry.key, ": ", Quoted{entry.value},
                    " is not a number of 0..", highest, "; it was left out");
    return std::nullopt;
  }
  report_quirks(report_, number->quirks, entry.value, entry.pos(), entry.key);
  return static_cast<std::uint32_t>(number->magnitude);
}

bool ValueReader::read_flag(const IniEntry& entry) {
  const auto number = parse_number(entry.value);
  const auto bare = without_comment(entry.value);
  if (!number && bare.empty()) return false;
  const bool set =
      number ? number->magnitude != 0 || number->relative() : boolean_word(bare).value_or(false);
  if (!number || !number->is_within(1)) {
    report_.warning(entry.pos(), "boolean-word", entry.key, ": ", Quoted{entry.value},
                    " was read as ", set ? "1" : "0", "; write 0 or 1");
  } else if (number->has(NumberQuirk::comment)) {
    report_quirks(report_, quirk_bit(NumberQuirk::comment), entry.value, entry.pos(), entry.key);
  }
  return set;
}

std::string_view ValueReader::without_reported_comment(std::string_view text,
                                                       const ValuePlace& place) {
  const auto bare = without_comment(text);
  if (bare.size() != trim(text).size()) {
    report_quirks(report_, quirk_bit(NumberQuirk::comment), text, place.pos, place);
  }
  return bare;
}

void ValueReader::exceeds(std::string_view text, DataType type, const ValuePlace& place) {
  report_.add(place.misfit, place.pos, "value-exceeds-type", place, ": ", Quoted{text},
              " does not fit ", type, "; the value is dropped, not cut to fit");
}

void ValueReader::report_wrapped(std::string_view text, DataType type, const Value& value,
                                 const ValuePlace& place) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) {
    report_.note(place.pos, "bit-pattern", place, ": ", Quoted{text}, " is the bit pattern of ",
                 *number, " in ", type);
  } else {
    report_.warning(place.pos, "negative-unsigned", place, ": ", Quoted{text}, " in ", type,
                    " was read as the bit pattern ", std::get<std::uint64_t>(value));
  }
}

void ValueReader::unreadable(std::string_view text, std::string_view wanted,
                             const ValuePlace& place) {
  report_.add(place.unreadable, place.pos, "value-unreadable", place, ": ", Quoted{text},
              " is not ", wanted, "; the value is dropped");
}

}  // namespace takt
