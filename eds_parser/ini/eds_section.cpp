#include "eds_parser/ini/eds_section.hpp"

#include <algorithm>
#include <bit>

#include "eds_parser/ini/eds_lists.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

struct KnownSection {
  std::string_view name;
  SectionKind kind;
};

constexpr KnownSection known_sections[] = {
    {"fileinfo", SectionKind::file_info},
    {"deviceinfo", SectionKind::device_info},
    {"dummyusage", SectionKind::dummy_usage},
    {"comments", SectionKind::comments},
    {"tools", SectionKind::tools},
    {"mandatoryobjects", SectionKind::mandatory_objects},
    {"optionalobjects", SectionKind::optional_objects},
    {"manufacturerobjects", SectionKind::manufacturer_objects},
    {"devicecomissioning", SectionKind::commissioning},
    {"devicecommissioning", SectionKind::commissioning_two_m},
    {"dynamicchannels", SectionKind::dynamic_channels},
    {"supportedmodules", SectionKind::supported_modules},
    {"connectedmodules", SectionKind::connected_modules},
};

/// Classifies the text after the four digits of an index.
SectionName classify_suffix(std::string_view written, std::uint16_t index) noexcept {
  const auto suffix = trim(written);
  SectionName name{.kind = SectionKind::object, .index = index};
  if (suffix.empty()) return name;
  name.blank = is_blank(written.front());
  if (has_prefix(suffix, "sub")) {
    const auto digits = trim(suffix.substr(3));
    const auto sub = hex_digits(digits);
    if (!sub || *sub > 0xFF || digits.size() > 4) return {};
    name.kind = SectionKind::sub_object;
    name.sub = static_cast<std::uint8_t>(*sub);
    name.blank = name.blank || is_blank(suffix[3]);
    name.leading_zero = digits.size() > 1 && digits.front() == '0';
    return name;
  }
  name.kind = same_word(suffix, "name")          ? SectionKind::name_list
              : same_word(suffix, "value")       ? SectionKind::value_list
              : same_word(suffix, "denotation")  ? SectionKind::denotation_list
              : same_word(suffix, "objectlinks") ? SectionKind::object_links
                                                 : SectionKind::unknown;
  return name;
}

/// Classifies `M<decimal><word>`, such as [M1ModuleInfo] and [M12Fixed6000sub1].
SectionName classify_module(std::string_view name) noexcept {
  std::size_t at = 1;
  std::uint32_t number = 0;
  for (; at < name.size() && name[at] >= '0' && name[at] <= '9' && number < 10000; ++at) {
    number = number * 10 + static_cast<std::uint32_t>(name[at] - '0');
  }
  if (at == 1 || at == name.size() || number > 0xFFFF) return {};
  const auto part = name.substr(at);
  for (const auto* word : {"moduleinfo", "comments", "fixed", "subext"}) {
    if (!has_prefix(part, word)) continue;
    return {.kind = SectionKind::module,
            .module = static_cast<std::uint16_t>(number),
            .module_part = part};
  }
  return {};
}

bool is_tool(std::string_view name) noexcept {
  if (!has_prefix(name, "tool") || name.size() == 4) return false;
  return name.find_first_not_of("0123456789", 4) == std::string_view::npos;
}

/// Folds letters to lower case: bit 5 distinguishes lower from upper case. Only the two forms of a
/// letter become the lower-case letter, no other byte does.
template <std::size_t n>
constexpr std::uint64_t folded(const char* letters) noexcept {
  std::array<char, 8> eight{};
  std::copy_n(letters, n, eight.begin());
  return std::bit_cast<std::uint64_t>(eight) | 0x2020'2020'2020'2020;
}

/// A keyword of 4 to 16 letters in lower case, packed into two numbers: `first` holds its first 8
/// letters and `last` its last 8. If the keyword has fewer than 8 letters, each number holds 4.
struct FoldedWord {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  std::size_t size = 0;

  constexpr FoldedWord() = default;
  constexpr explicit FoldedWord(std::string_view word) noexcept : size{word.size()} {
    const bool is_short = size < 8;
    first = is_short ? folded<4>(word.data()) : folded<8>(word.data());
    last = is_short ? folded<4>(word.data() + size - 4) : folded<8>(word.data() + size - 8);
  }
  constexpr bool operator==(const FoldedWord&) const = default;
  constexpr std::size_t hash(std::uint64_t factor) const noexcept {
    return ((first ^ std::rotl(last, 7)) * factor) >> 58;
  }
};

struct KnownKey {
  std::string_view name;
  Keyword keyword = Keyword::unknown;
};

constexpr KnownKey known_keys[] = {
    {"parametername", Keyword::parameter_name},
    {"objecttype", Keyword::object_type},
    {"datatype", Keyword::data_type},
    {"lowlimit", Keyword::low_limit},
    {"highlimit", Keyword::high_limit},
    {"accesstype", Keyword::access_type},
    {"defaultvalue", Keyword::default_value},
    {"pdomapping", Keyword::pdo_mapping},
    {"subnumber", Keyword::sub_number},
    {"objflags", Keyword::obj_flags},
    {"compactsubobj", Keyword::compact_sub_obj},
    {"parametervalue", Keyword::parameter_value},
    {"denotation", Keyword::denotation},
    {"uploadfile", Keyword::upload_file},
    {"downloadfile", Keyword::download_file},
    {"count", Keyword::module_count},
    {"objextend", Keyword::module_extend},
    {"paramrefd", Keyword::param_refd},
    {"srdomapping", Keyword::other_known},
    {"invertedsrad", Keyword::other_known},
    {"description", Keyword::other_known},
    {"factor", Keyword::other_known},
    {"unit", Keyword::other_known},
};

/// A hash table without collisions: each lookup needs one access and one comparison.
struct KeyTable {
  struct Place {
    FoldedWord word;
    Keyword keyword = Keyword::unknown;
  };
  std::array<Place, 64> places{};
  std::uint64_t factor = 0;
};

consteval KeyTable make_key_table() {
  for (std::uint64_t factor = 0x9E37'79B9'7F4A'7C15;; factor += 0x1000'0000'0002) {
    KeyTable table;
    table.factor = factor;
    const bool all = std::ranges::all_of(known_keys, [&](const KnownKey& key) {
      const FoldedWord word{key.name};
      auto& place = table.places[word.hash(factor)];
      const bool free = place.keyword == Keyword::unknown;
      place = {word, key.keyword};
      return free;
    });
    if (all) return table;
  }
}

constexpr KeyTable key_table = make_key_table();

}  // namespace

SectionName classify_section(std::string_view name) noexcept {
  const bool prefixed = is_prefixed_hex(name);
  const auto digits = prefixed ? name.substr(2) : name;
  if (const auto number = hex_digits(digits.substr(0, 4))) {
    const auto index = static_cast<std::uint16_t>(*number);
    if (digits.size() < 4) return {.kind = SectionKind::short_object, .index = index};
    auto found = classify_suffix(digits.substr(4), index);
    found.prefixed = prefixed;
    if (found.kind != SectionKind::unknown) return found;
  }
  for (const auto& known : known_sections) {
    if (same_word(name, known.name)) return {.kind = known.kind};
  }
  if (is_tool(name)) return {.kind = SectionKind::tools};
  if (!name.empty() && fold(name.front()) == 'm') return classify_module(name);
  return {};
}

SectionName classify_section(const IniSection& section) noexcept {
  if (!section.has_decimal_sub) return classify_section(section.name);
  SectionName name = classify_section(section.name.substr(0, 4));
  name.kind = SectionKind::sub_object;
  name.sub = static_cast<std::uint8_t>(entry_number(section.name.substr(7)).value_or(0));
  return name;
}

void report_blank_in_name(const IniSection& section, Report& report) {
  report.warning(section.pos, "section-name-blank", "section ", Quoted{section.name},
                 " has a blank in its name or around it; it was read, other tools lose it");
}

void report_list_without_object(const IniSection& list, Report& report) {
  report.warning(list.pos, "object-section-missing", "section ", Quoted{list.name},
                 " belongs to an object that has no section; it was left out");
}

void report_unknown_key(const IniEntry& entry, std::string_view section, Report& report) {
  report.warning(entry.key_pos(), "unknown-key", "key ", Quoted{entry.key}, " of [", Utf8{section},
                 "] is not one of CiA 306; it was left out");
}

void check_entry_count(const IniEntry& count, std::size_t found, std::string_view section,
                       Report& report) {
  const auto declared = parse_number(count.value);
  if (declared && declared->magnitude == found && !declared->negative) return;
  if (!declared && declared.error() == NumberFault::empty && found == 0) return;
  report.warning(count.pos(), "entry-count-wrong", Utf8{count.key}, " of [", Utf8{section}, "] is ",
                 Quoted{count.value}, ", but ",
                 found == 0   ? "there are no entries"
                 : found == 1 ? "1 entry exists; it was read"
                              : std::to_string(found) + " entries exist; all were read");
}

Keyword classify_key(std::string_view key) noexcept {
  if (key.size() < 4 || key.size() > 16) return Keyword::unknown;
  const FoldedWord word{key};
  const auto& place = key_table.places[word.hash(key_table.factor)];
  return place.word == word ? place.keyword : Keyword::unknown;
}

ObjectFields::ObjectFields(const IniFile& file, const IniSection& section, Report& report)
    : section_{section}, text_{file.text} {
  for (const auto& spot : file.entries(section).spots()) {
    const auto keyword = classify_key(spot.key_in(text_));
    if (keyword == Keyword::other_known) continue;
    if (keyword == Keyword::unknown) {
      report_unknown_key(spot.entry_in(text_), section.name, report);
      continue;
    }
    auto& first = slots_[static_cast<std::size_t>(keyword)];
    if (first == nullptr) {
      first = &spot;
    } else if (first->value_in(text_) != spot.value_in(text_)) {
      const auto entry = spot.entry_in(text_);
      report.warning(entry.pos(), "duplicate-key", "key ", Quoted{entry.key}, " of [",
                     Utf8{section.name},
                     "] is repeated with another value; the first one applies, ",
                     Quoted{first->value_in(text_)});
    }
  }
}

}  // namespace takt
