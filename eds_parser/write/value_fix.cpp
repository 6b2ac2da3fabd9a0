#include "eds_parser/write/value_fix.hpp"

#include "eds_parser/eds_section.hpp"
#include "eds_parser/number.hpp"
#include "eds_parser/text.hpp"
#include "eds_parser/write/object_sections.hpp"

namespace takt {
namespace {

const std::optional<Value>* value_of(const SubObject& sub, Keyword keyword) {
  switch (keyword) {
    case Keyword::default_value:
      return &sub.default_value;
    case Keyword::parameter_value:
      return &sub.parameter_value;
    case Keyword::low_limit:
      return &sub.low_limit;
    case Keyword::high_limit:
      return &sub.high_limit;
    default:
      return nullptr;
  }
}

std::string magnitude_text(const ParsedNumber& number) {
  return number.hex ? hex(0, 1).substr(0, 2) + [&] {
    std::string digits;
    for (std::uint64_t rest = number.magnitude; rest != 0; rest >>= 4U) {
      digits.insert(digits.begin(), "0123456789ABCDEF"[rest & 0xFU]);
    }
    return digits.empty() ? std::string{"0"} : digits;
  }()
                    : std::to_string(number.magnitude);
}

}  // namespace

std::optional<std::string> plain_number(std::string_view text) {
  const auto number = parse_number(text);
  if (!number) return {};
  std::string plain;
  for (unsigned i = 0; i < number->node_ids; ++i) plain += plain.empty() ? "$NODEID" : "+$NODEID";
  const bool only_id = number->relative() && number->magnitude == 0;
  if (number->negative) plain += '-';
  if (number->relative() && !number->negative && !only_id) plain += '+';
  if (!only_id) plain += magnitude_text(*number);
  const auto again = parse_number(plain);
  const bool same = again && again->magnitude == number->magnitude &&
                    again->negative == number->negative && again->node_ids == number->node_ids &&
                    again->quirks == 0;
  return same ? std::optional{plain} : std::nullopt;
}

std::optional<std::string> plain_flag(std::string_view text) {
  const std::string_view word = without_comment(text);
  for (const auto* yes : {"true", "yes", "on"}) {
    if (same_word(word, yes)) return "1";
  }
  for (const auto* no : {"false", "no", "off"}) {
    if (same_word(word, no)) return "0";
  }
  return {};
}

std::optional<std::string> value_as_read(const ObjectDictionary& dictionary,
                                         const IniSection& section, std::string_view key) {
  const SectionName name = classify_section(section);
  if (name.kind != SectionKind::object && name.kind != SectionKind::sub_object) return {};
  const SubObject* sub = dictionary.find(ObjectKey{name.index, name.sub});
  const std::optional<Value>* value = sub == nullptr ? nullptr : value_of(*sub, classify_key(key));
  if (value == nullptr || !*value) return {};
  if (const auto* number = std::get_if<std::uint64_t>(&**value)) {
    return magnitude_text({.magnitude = *number, .hex = true});
  }
  return eds_value_text(**value, sub->type);
}

}  // namespace takt
