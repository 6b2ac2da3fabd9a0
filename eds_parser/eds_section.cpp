#include "eds_parser/eds_section.hpp"

#include "eds_parser/text.hpp"

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

/// Up to `most` hex digits from `at` on; returns how many there were.
std::size_t take_hex(std::string_view text, std::size_t most, std::uint32_t& value) noexcept {
  std::size_t count = 0;
  for (value = 0; count < most && count < text.size(); ++count) {
    const int digit = hex_digit(text[count]);
    if (digit < 0) break;
    value = value << 4 | static_cast<std::uint32_t>(digit);
  }
  return count;
}

bool has_prefix(std::string_view text, std::string_view lower) noexcept {
  return text.size() >= lower.size() && same_word(text.substr(0, lower.size()), lower);
}

/// What follows the four digits of an index.
SectionName classify_suffix(std::string_view suffix, std::uint16_t index) noexcept {
  SectionName name{.kind = SectionKind::object, .index = index};
  if (suffix.empty()) return name;
  if (has_prefix(suffix, "sub")) {
    const auto digits = trim(suffix.substr(3));
    std::uint32_t sub = 0;
    const auto count = take_hex(digits, 4, sub);
    const bool good = count > 0 && count == digits.size() && sub <= 0xFF;
    if (!good) return {};
    name.kind = SectionKind::sub_object;
    name.sub = static_cast<std::uint8_t>(sub);
    name.leading_zero = count > 1 && digits.front() == '0';
    return name;
  }
  name.kind = same_word(suffix, "name")          ? SectionKind::name_list
              : same_word(suffix, "value")       ? SectionKind::value_list
              : same_word(suffix, "denotation")  ? SectionKind::denotation_list
              : same_word(suffix, "objectlinks") ? SectionKind::object_links
                                                 : SectionKind::unknown;
  return name;
}

/// `M<decimal><word>`: [M1ModuleInfo], [M12Fixed6000sub1].
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

}  // namespace

SectionName classify_section(std::string_view name) noexcept {
  std::uint32_t index = 0;
  const bool prefixed = name.size() > 2 && name[0] == '0' && fold(name[1]) == 'x';
  const auto digits = prefixed ? name.substr(2) : name;
  const auto count = take_hex(digits, 4, index);
  if (count == 4) {
    auto found = classify_suffix(digits.substr(4), static_cast<std::uint16_t>(index));
    found.prefixed = prefixed;
    if (found.kind != SectionKind::unknown) return found;
  } else if (count > 0 && count == digits.size()) {
    return {.kind = SectionKind::short_object, .index = static_cast<std::uint16_t>(index)};
  }
  for (const auto& known : known_sections) {
    if (same_word(name, known.name)) return {.kind = known.kind};
  }
  if (is_tool(name)) return {.kind = SectionKind::tools};
  if (!name.empty() && fold(name.front()) == 'm') return classify_module(name);
  return {};
}

Keyword classify_key(std::string_view key) noexcept {
  struct Known {
    std::string_view name;
    Keyword keyword;
  };
  const auto match = [key](std::initializer_list<Known> candidates) {
    for (const auto& known : candidates) {
      if (same_word(key, known.name)) return known.keyword;
    }
    return Keyword::unknown;
  };
  switch (key.size()) {
    case 4:
      return match({{"unit", Keyword::other_known}});
    case 5:
      return match({{"count", Keyword::module_count}});
    case 6:
      return match({{"factor", Keyword::other_known}});
    case 8:
      return match({{"datatype", Keyword::data_type},
                    {"objflags", Keyword::obj_flags},
                    {"lowlimit", Keyword::low_limit}});
    case 9:
      return match({{"highlimit", Keyword::high_limit},
                    {"subnumber", Keyword::sub_number},
                    {"paramrefd", Keyword::other_known},
                    {"objextend", Keyword::module_extend}});
    case 10:
      return match({{"objecttype", Keyword::object_type},
                    {"accesstype", Keyword::access_type},
                    {"pdomapping", Keyword::pdo_mapping},
                    {"denotation", Keyword::denotation},
                    {"uploadfile", Keyword::upload_file}});
    case 11:
      return match({{"srdomapping", Keyword::other_known}, {"description", Keyword::other_known}});
    case 12:
      return match({{"defaultvalue", Keyword::default_value},
                    {"downloadfile", Keyword::download_file},
                    {"invertedsrad", Keyword::other_known}});
    case 13:
      return match({{"parametername", Keyword::parameter_name},
                    {"compactsubobj", Keyword::compact_sub_obj}});
    case 14:
      return match({{"parametervalue", Keyword::parameter_value}});
    default:
      return Keyword::unknown;
  }
}

ObjectFields::ObjectFields(std::span<const IniEntry> entries, std::string_view section,
                           Report& report) {
  for (const auto& entry : entries) {
    const auto keyword = classify_key(entry.key);
    if (keyword == Keyword::other_known) continue;
    if (keyword == Keyword::unknown) {
      if (report.wants("unknown-key")) {
        report.warning(entry.key_pos(), "unknown-key",
                       "key " + quoted(entry.key) + " of [" + to_utf8(section) +
                           "] is not one of CiA 306; it was left out");
      }
      continue;
    }
    auto& slot = slots_[static_cast<std::size_t>(keyword)];
    if (slot == nullptr) {
      slot = &entry;
    } else if (slot->value != entry.value && report.wants("duplicate-key")) {
      report.warning(entry.pos(), "duplicate-key",
                     "key " + quoted(entry.key) + " of [" + to_utf8(section) +
                         "] repeated with another value; the first one counts, " +
                         quoted(slot->value));
    }
  }
}

}  // namespace takt
