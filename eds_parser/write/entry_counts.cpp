#include "eds_parser/write/entry_counts.hpp"

#include <algorithm>
#include <set>

#include "eds_parser/ini/eds_lists.hpp"
#include "eds_parser/ini/eds_section.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

std::size_t tools(const IniFile& file) {
  return static_cast<std::size_t>(
      std::ranges::count_if(file.sections, [](const IniSection& section) {
        return classify_section(section).kind == SectionKind::tools &&
               !same_word(section.name, "tools");
      }));
}

/// Returns the number of module types. A type that is described several times counts once.
std::size_t modules(const IniFile& file) {
  std::set<std::uint16_t> numbers;
  for (const IniSection& section : file.sections) {
    const SectionName name = classify_section(section);
    const bool is_type =
        name.kind == SectionKind::module && same_word(name.module_part, "moduleinfo");
    if (is_type) numbers.insert(name.module);
  }
  return numbers.size();
}

}  // namespace

std::optional<std::size_t> counted_entries(const IniFile& file, const IniSection& section) {
  switch (classify_section(section).kind) {
    case SectionKind::name_list:
    case SectionKind::value_list:
    case SectionKind::denotation_list:
    case SectionKind::object_links:
    case SectionKind::connected_modules:
    case SectionKind::module:
      return numbered_entries(file.entries(section));
    case SectionKind::comments:
      return numbered_entries(file.entries(section), "line");
    case SectionKind::tools:
      return tools(file);
    case SectionKind::supported_modules:
      return modules(file);
    default:
      return std::nullopt;
  }
}

}  // namespace takt
