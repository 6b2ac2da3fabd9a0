#include "eds_parser/read/object_words.hpp"

#include <algorithm>
#include <iterator>

#include "eds_parser/ini/number.hpp"
#include "eds_parser/report/text.hpp"
#include "eds_parser/table/device_table.hpp"

namespace takt {
namespace {

struct ObjectTypeWord {
  std::string_view word;
  ObjectType type;
};

constexpr ObjectTypeWord object_type_words[] = {
    {"null", ObjectType::null},       {"domain", ObjectType::domain},
    {"deftype", ObjectType::deftype}, {"defstruct", ObjectType::defstruct},
    {"var", ObjectType::var},         {"variable", ObjectType::var},
    {"array", ObjectType::array},     {"record", ObjectType::record}};

std::optional<std::uint32_t> object_type_code(std::string_view text) noexcept {
  const auto* it = std::ranges::find_if(
      object_type_words, [text](const auto& known) { return same_word(text, known.word); });
  if (it == std::end(object_type_words)) return std::nullopt;
  return static_cast<std::uint32_t>(it->type);
}

std::optional<std::uint32_t> data_type_code(std::string_view text) noexcept {
  for (std::uint32_t code = 1; code <= static_cast<std::uint32_t>(DataType::unsigned64); ++code) {
    const auto word = name(static_cast<DataType>(code));
    if (word != "unknown" && std::ranges::equal(text, word, {}, fold, fold)) return code;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Access> access_of_word(std::string_view text) noexcept {
  using enum Access;
  for (const Access access : {ro, wo, rw, rwr, rww, constant}) {
    if (same_word(text, access_name(access))) return access;
  }
  return std::nullopt;
}

std::optional<Access> access_of_letter(std::string_view text) noexcept {
  if (same_word(text, "r")) return Access::ro;
  return same_word(text, "w") ? std::optional{Access::wo} : std::nullopt;
}

std::optional<std::uint32_t> code_of_word(Keyword keyword, std::string_view text) noexcept {
  const auto word = without_comment(text);
  if (word.empty() || (word.front() >= '0' && word.front() <= '9')) return std::nullopt;
  if (keyword == Keyword::object_type) return object_type_code(word);
  return keyword == Keyword::data_type ? data_type_code(word) : std::nullopt;
}

std::optional<std::uint32_t> read_type_code(const ObjectFields& fields, Keyword keyword,
                                            ValueReader& values, Report& report) {
  const auto entry = fields.get(keyword);
  if (!entry) return std::nullopt;
  const auto code = code_of_word(keyword, entry->value);
  if (!code) return values.read_count(*entry, keyword == Keyword::object_type ? 0xFF : 0xFFFF);
  const auto bare = without_comment(entry->value);
  report.warning(entry->pos(), "type-word", Quoted{bare}, " was read as ", Hex{*code},
                 "; CiA 306 requires the number here");
  if (bare.size() != entry->value.size()) {
    report.warning(entry->pos(), "inline-comment", entry->key,
                   ": text behind ';' or '#' was read as a comment");
  }
  return code;
}

bool is_domain_object(const ObjectFields& fields) noexcept {
  constexpr auto domain = static_cast<std::uint32_t>(ObjectType::domain);
  const auto text = fields.text(Keyword::object_type);
  if (const auto code = code_of_word(Keyword::object_type, text)) return *code == domain;
  const auto number = parse_number(text);
  return number && number->is_within(domain) && number->magnitude == domain;
}

}  // namespace takt
