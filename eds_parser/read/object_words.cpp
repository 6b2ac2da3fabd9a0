#include "eds_parser/read/object_words.hpp"

#include <algorithm>
#include <span>

#include "eds_parser/ini/number.hpp"
#include "eds_parser/report/text.hpp"
#include "eds_parser/table/ids.hpp"

namespace takt {
namespace {

template <class T>
struct Word {
  std::string_view text;
  T meaning;
};

template <class T>
std::optional<T> meaning_of(std::string_view text, std::span<const Word<T>> words) noexcept {
  const auto it = std::ranges::find_if(
      words, [text](const Word<T>& word) { return same_word(text, word.text); });
  return it == words.end() ? std::nullopt : std::optional{it->meaning};
}

constexpr Word<Access> access_words[] = {{"ro", Access::ro},   {"wo", Access::wo},
                                         {"rw", Access::rw},   {"rwr", Access::rwr},
                                         {"rww", Access::rww}, {"const", Access::constant}};

constexpr Word<Access> access_letters[] = {{"r", Access::ro}, {"w", Access::wo}};

constexpr Word<ObjectType> object_type_words[] = {
    {"null", ObjectType::null},       {"domain", ObjectType::domain},
    {"deftype", ObjectType::deftype}, {"defstruct", ObjectType::defstruct},
    {"var", ObjectType::var},         {"variable", ObjectType::var},
    {"array", ObjectType::array},     {"record", ObjectType::record}};

bool may_be_word(std::string_view text) noexcept {
  return !text.empty() && (text.front() < '0' || text.front() > '9');
}

std::optional<ObjectType> object_type_of(std::string_view text) noexcept {
  if (!may_be_word(text)) return std::nullopt;
  return meaning_of<ObjectType>(text, object_type_words);
}

std::optional<DataType> data_type_of_word(std::string_view text) noexcept {
  if (!may_be_word(text)) return std::nullopt;
  for (unsigned code = 1; code <= static_cast<unsigned>(DataType::unsigned64); ++code) {
    const auto type = static_cast<DataType>(code);
    const auto word = name(type);
    if (word != "unknown" && std::ranges::equal(text, word, {}, fold, fold)) return type;
  }
  return std::nullopt;
}

struct CodeKey {
  Keyword keyword;
  std::string_view name;
  std::uint32_t highest;
};

std::optional<std::uint32_t> read_code(const ObjectFields& fields, const CodeKey& key,
                                       SourcePos pos, ValueReader& values, Report& report) {
  const auto text = fields.text(key.keyword);
  const auto code = code_of_word(key.keyword, text);
  if (!code) return values.read_count(text, key.highest, key.name, pos);
  const auto bare = without_comment(text);
  if (report.wants("type-word")) {
    report.warning(
        pos, "type-word",
        quoted(bare) + " was read as " + hex(*code) + "; CiA 306 requires the number here");
  }
  if (bare.size() != text.size()) {
    report.warning(pos, "inline-comment",
                   std::string{key.name} + ": text behind ';' or '#' was read as a comment");
  }
  return code;
}

}  // namespace

std::optional<Access> access_of_word(std::string_view text) noexcept {
  return meaning_of<Access>(text, access_words);
}

std::optional<Access> access_of_letter(std::string_view text) noexcept {
  return meaning_of<Access>(text, access_letters);
}

std::optional<std::uint32_t> code_of_word(Keyword keyword, std::string_view text) noexcept {
  const auto word = without_comment(text);
  if (keyword == Keyword::object_type) {
    const auto type = object_type_of(word);
    return type ? std::optional{static_cast<std::uint32_t>(*type)} : std::nullopt;
  }
  if (keyword != Keyword::data_type) return std::nullopt;
  const auto type = data_type_of_word(word);
  return type ? std::optional{static_cast<std::uint32_t>(*type)} : std::nullopt;
}

std::optional<std::uint32_t> read_object_type_code(const ObjectFields& fields, SourcePos pos,
                                                   ValueReader& values, Report& report) {
  return read_code(fields, {Keyword::object_type, "ObjectType", 0xFF}, pos, values, report);
}

std::optional<std::uint32_t> read_data_type_code(const ObjectFields& fields, SourcePos pos,
                                                 ValueReader& values, Report& report) {
  return read_code(fields, {Keyword::data_type, "DataType", 0xFFFF}, pos, values, report);
}

bool is_domain_object(const ObjectFields& fields) noexcept {
  constexpr auto domain = static_cast<std::uint32_t>(ObjectType::domain);
  const auto text = fields.text(Keyword::object_type);
  if (const auto code = code_of_word(Keyword::object_type, text)) return *code == domain;
  const auto number = parse_number(text);
  return number && !number->negative && !number->relative() && number->magnitude == domain;
}

}  // namespace takt
