#include "eds_parser/write/value_fix.hpp"

#include <algorithm>
#include <array>

#include "eds_parser/ini/eds_lists.hpp"
#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/read/object_words.hpp"
#include "eds_parser/report/text.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {
namespace {

using Rules = std::set<std::string_view>;

constexpr std::array<std::string_view, 14> value_rules{
    "access-type-letter",    "boolean-word",  "hex-without-prefix", "inline-comment",
    "integer-with-fraction", "leading-zero",  "negative-unsigned",  "nodeid-not-first",
    "nodeid-without-dollar", "number-suffix", "octal-number",       "octet-string-form",
    "real-bit-pattern",      "type-word"};

/// Returns the keyword of an entry that gives an element a value, or Keyword::unknown for other
/// entries.
Keyword value_keyword(const SectionName& section, std::string_view key) noexcept {
  if (section.kind == SectionKind::value_list) {
    return entry_number(key) ? Keyword::parameter_value : Keyword::unknown;
  }
  constexpr Keyword keywords[] = {Keyword::default_value, Keyword::parameter_value,
                                  Keyword::low_limit, Keyword::high_limit};
  const auto* found = std::ranges::find(keywords, classify_key(key));
  return found == std::end(keywords) ? Keyword::unknown : *found;
}

/// Returns the element that the section of an object describes: a VAR, or an element by
/// CompactSubObj.
const SubObject* described_by(const Object& object, const IniSection& section) noexcept {
  const bool has_elements = object.type == ObjectType::array || object.type == ObjectType::record ||
                            object.type == ObjectType::defstruct;
  const auto found = std::ranges::find_if(object.subs, [&](const SubObject& sub) {
    return sub.pos == section.pos && has_elements == (sub.sub != 0);
  });
  return found == object.subs.end() ? nullptr : &*found;
}

/// Returns the element to which an entry belongs, or nullptr if there is none or if it is not
/// clear.
const SubObject* element_of(const ObjectDictionary& dictionary, const IniSection& section,
                            std::string_view key) noexcept {
  const SectionName name = classify_section(section);
  if (name.kind == SectionKind::sub_object) return dictionary.find({name.index, name.sub});
  if (name.kind == SectionKind::value_list) {
    const auto sub = entry_number(key);
    if (!sub || *sub > 0xFF) return nullptr;
    return dictionary.find({name.index, static_cast<std::uint8_t>(*sub)});
  }
  if (name.kind != SectionKind::object) return nullptr;
  const Object* object = dictionary.find(name.index);
  return object == nullptr ? nullptr : described_by(*object, section);
}

/// Returns the value that was read from this entry, or std::nullopt if the value comes from another
/// entry.
std::optional<Value> value_read(const SubObject& sub, Keyword keyword, const IniEntry& entry) {
  if (keyword == Keyword::low_limit) return sub.low_limit;
  if (keyword == Keyword::high_limit) return sub.high_limit;
  const bool is_default = keyword == Keyword::default_value;
  const SourcePos read_at = is_default ? sub.default_pos : sub.parameter_pos;
  if (read_at != entry.pos()) return std::nullopt;
  return is_default ? sub.default_value : sub.parameter_value;
}

/// Returns a number in plain notation. Hexadecimal stays hexadecimal. Returns std::nullopt if the
/// text is not a number, or if no plain notation reads back as the same number.
std::optional<std::string> plain_number(std::string_view bare) {
  const auto number = parse_number(bare);
  if (!number) return {};
  if (number->quirks == 0) return std::string{bare};
  std::string plain;
  for (unsigned i = 0; i < number->node_ids; ++i) plain += plain.empty() ? "$NODEID" : "+$NODEID";
  const bool only_id = number->relative() && number->magnitude == 0;
  if (number->negative) plain += '-';
  if (number->relative() && !number->negative && !only_id) plain += '+';
  if (!only_id) {
    plain += number->hex ? hex64(number->magnitude, 1) : std::to_string(number->magnitude);
  }
  const auto again = parse_number(plain);
  const bool same = again && again->magnitude == number->magnitude &&
                    again->negative == number->negative && again->node_ids == number->node_ids &&
                    again->quirks == 0;
  return same ? std::optional{plain} : std::nullopt;
}

/// Returns `1` for `true` and numbers other than 0, `0` for `false` and 0, and std::nullopt for
/// other texts.
std::optional<std::string> plain_flag(std::string_view bare) {
  if (const auto word = boolean_word(bare)) return *word ? "1" : "0";
  const auto number = parse_number(bare);
  if (number && !number->relative()) return number->magnitude == 0 ? "0" : "1";
  return {};
}

/// Returns the text of a value, or std::nullopt if it is relative to the node-ID, because the text
/// would lose this relation.
std::optional<std::string> value_text(const std::optional<Value>& value, DataType type,
                                      std::string_view bare) {
  const auto written = parse_number(bare);
  if (!value || (written && written->relative())) return {};
  if (const auto* number = std::get_if<std::uint64_t>(&*value)) return hex64(*number, 1);
  return eds_value_text(*value, type);
}

std::string without_suffix(std::string_view real) {
  const bool suffix = real.size() > 1 && fold(real.back()) == 'f' &&
                      std::string_view{"0123456789."}.contains(real[real.size() - 2]);
  return std::string{real.substr(0, real.size() - (suffix ? 1 : 0))};
}

std::optional<std::string> plain_element(const SubObject& element, Keyword keyword,
                                         const IniEntry& entry, const Rules& rules) {
  const std::string_view bare = without_comment(entry.value);
  const bool other_form = rules.contains("real-bit-pattern") ||
                          rules.contains("octet-string-form") ||
                          rules.contains("negative-unsigned");
  if (element.type == DataType::unknown) return {};
  if (other_form || (is_real(element.type) && is_prefixed_hex(bare))) {
    return value_text(value_read(element, keyword, entry), element.type, bare);
  }
  if (is_real(element.type)) return without_suffix(bare);
  const bool two_numbers = bare.find_first_of(" \t") != std::string_view::npos;
  if (is_bytes(element.type) || (is_time(element.type) && two_numbers)) return std::string{bare};
  return rules.contains("boolean-word") ? plain_flag(bare) : plain_number(bare);
}

bool in_list(SectionKind kind) noexcept {
  return kind >= SectionKind::mandatory_objects && kind <= SectionKind::manufacturer_objects;
}

}  // namespace

bool is_value_rule(std::string_view rule) noexcept {
  return std::ranges::find(value_rules, rule) != value_rules.end();
}

std::optional<std::string> plain_value(const ObjectDictionary& dictionary,
                                       const IniSection& section, const IniEntry& entry,
                                       const Rules& rules) {
  const std::string_view bare = without_comment(entry.value);
  const SectionName name = classify_section(section);
  const Keyword keyword = value_keyword(name, entry.key);
  if (keyword != Keyword::unknown) {
    const SubObject* element = element_of(dictionary, section, entry.key);
    return element == nullptr ? std::nullopt : plain_element(*element, keyword, entry, rules);
  }
  if (rules.contains("boolean-word")) return plain_flag(bare);
  if (rules.contains("hex-without-prefix") && in_list(name.kind)) return "0x" + std::string{bare};
  const Keyword other = classify_key(entry.key);
  if (const auto code = code_of_word(other, bare)) {
    return hex(*code, other == Keyword::object_type ? 1 : 4);
  }
  if (other == Keyword::access_type) {
    const auto letter = access_of_letter(bare);
    return std::string{letter ? access_name(*letter) : bare};
  }
  return plain_number(bare);
}

}  // namespace takt
